#include "io/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "core/atomic_file.h"
#include "core/errors.h"

namespace mcdem::inline io {
namespace {

enum class Answer {
    locked,
    held_by_others,
    no_locks
};  // some network file systems have no locks: ENOLCK, EBADF

Answer lock(int descriptor, int operation) {
    if (::flock(descriptor, operation | LOCK_NB) == 0) return Answer::locked;
    return errno == EWOULDBLOCK ? Answer::held_by_others : Answer::no_locks;
}

/// Reason why the lock is not available, and a remedy.
const char* obstacle(int descriptor, FolderLock::Use use) {
    if (use == FolderLock::Use::shared)
        return ": another program is writing there alone, which cannot be shared: wait for it, or give "
               "another folder";
    const bool is_shared = lock(descriptor, LOCK_SH) != Answer::held_by_others;
    return is_shared ? ": other programs share work there: wait for them, or give another folder"
                     : ": another program is writing there: wait for it, or give another folder";
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder, Use use)
    : descriptor_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (descriptor_ < 0)
        throw RunError(folder.string() + ": cannot be opened: " + std::generic_category().message(errno));
    const Answer answer = lock(descriptor_, use == Use::alone ? LOCK_EX : LOCK_SH);
    if (answer == Answer::locked && use == Use::alone) remove_temporaries(folder);
    if (answer != Answer::held_by_others) return;
    const std::string problem = folder.string() + obstacle(descriptor_, use);
    ::close(descriptor_);
    throw InputError(problem);
}

FolderLock::FolderLock(FolderLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

FolderLock::~FolderLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace mcdem::io
