#include "core/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <random>
#include <system_error>
#include <utility>
#include <vector>

#include "core/errors.h"
#include "core/look.h"

namespace mcdem::inline core {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view ending = ".tmp";
constexpr std::size_t digits = 16;  ///< of the random part of a temporary name

[[noreturn]] void fail(const fs::path& file, int error) {
    throw RunError(file.string() + ": cannot be written: " + std::generic_category().message(error));
}

/// `<file>.<16 hexadecimal digits>.tmp`
fs::path temporary_of(const fs::path& file) {
    std::random_device random;
    fs::path temporary = file;
    temporary += fmt::format(".{:08x}{:08x}{}", random(), random(), ending);
    return temporary;
}

bool is_temporary(const fs::path& file) {
    const std::string name = file.filename().string();
    if (name.size() <= digits + 1 + ending.size() || !name.ends_with(ending)) return false;
    const std::string_view random =
        std::string_view(name).substr(name.size() - ending.size() - digits, digits);
    return name[name.size() - ending.size() - digits - 1] == '.' &&
           random.find_first_not_of("0123456789abcdef") == random.npos;
}

/// Those in the folder that can be listed: what stays is removed by a later call.
std::vector<fs::path> temporaries(const fs::path& folder) {
    std::vector<fs::path> found;
    std::error_code error;
    for (auto entry = fs::directory_iterator(folder, error); !error && entry != fs::directory_iterator();
         entry.increment(error))
        if (is_temporary(entry->path())) found.push_back(entry->path());
    return found;
}

/// The final name for a temporary name.
std::string temporary_place(const fs::path& temporary) {
    const std::string name = temporary.filename().string();
    return name.substr(0, name.size() - ending.size() - digits - 1);
}

/// Removes a temporary file or folder unless a running program has locked it.
void remove_if_abandoned(const fs::path& temporary) {
    const int descriptor = ::open(temporary.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) return;
    std::error_code ignored;
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) fs::remove_all(temporary, ignored);
    ::close(descriptor);
}

/// Locks a new file or folder. False if another program mistook it for an abandoned one and has removed it.
bool lock_before_removal(int descriptor) {
    int result = 0;
    do result = ::flock(descriptor, LOCK_EX);
    while (result != 0 && errno == EINTR);
    struct stat found {};
    return ::fstat(descriptor, &found) != 0 || found.st_nlink > 0;
}

void force_to_disk(int descriptor, const fs::path& file) {
    // Some file systems cannot sync (EINVAL, EROFS on folders); this is ignored.
    int result = 0;
    do result = ::fsync(descriptor);
    while (result != 0 && errno == EINTR);
    if (result != 0 && errno != EINVAL && errno != EROFS) fail(file, errno);
}

void force_folder_of(const fs::path& file) {
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) fail(folder, errno);
    try {
        force_to_disk(descriptor, folder);
    } catch (...) {
        ::close(descriptor);
        throw;
    }
    ::close(descriptor);
}

}  // namespace

NewFile::NewFile(fs::path place) : place_(std::move(place)) {
    while (descriptor_ < 0) {
        temporary_ = temporary_of(place_);
        descriptor_ = ::open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
        if (descriptor_ < 0 && errno != EEXIST && errno != EINTR) fail(place_, errno);
        if (descriptor_ >= 0 && !lock_before_removal(descriptor_)) ::close(std::exchange(descriptor_, -1));
    }
    lock_ = ::fcntl(descriptor_, F_DUPFD_CLOEXEC, 0);
}

NewFile::~NewFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
    if (lock_ >= 0) ::close(lock_);
}

void NewFile::write(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno != EINTR) fail(place_, errno);
        if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

void NewFile::close() {
    if (descriptor_ < 0) return;
    force_to_disk(descriptor_, place_);
    // close() releases the descriptor even if it is interrupted; network file systems report write errors
    // here.
    if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR) fail(place_, errno);
}

void NewFile::put_in_place() {
    close();
    move_file(temporary_, place_);
    temporary_.clear();
}

void replace_file(const fs::path& file, const std::function<void(NewFile& out)>& write) {
    NewFile out(file);
    write(out);
    out.put_in_place();
}

void replace_file(const fs::path& file, std::string_view text) {
    replace_file(file, [&](NewFile& out) { out.write(text); });
}

bool create_file(const fs::path& file, std::string_view text) {
    NewFile out(file);
    out.write(text);
    out.close();
    int error = ::link(out.temporary().c_str(), file.c_str()) == 0 ? 0 : errno;
    // A network file system may have created the link and lost the reply.
    if (error == EEXIST && fs::hard_link_count(out.temporary()) == 2) error = 0;
    if (error == EPERM || error == ENOSYS || error == EOPNOTSUPP) {
        // File systems without links: two programs at the same moment may both create the file.
        error = is_there(file) ? EEXIST : 0;
        if (error == 0) out.put_in_place();
    }
    if (error != 0 && error != EEXIST) fail(file, error);
    if (error == 0) force_folder_of(file);
    return error == 0;
}

void move_file(const fs::path& from, const fs::path& to) {
    std::error_code error;
    fs::rename(from, to, error);
    if (error) fail(to, error.value());
    force_folder_of(to);
}

void remove_temporaries_of(const fs::path& file) {
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    for (const fs::path& temporary : temporaries(folder))
        if (temporary_place(temporary) == file.filename()) remove_if_abandoned(temporary);
}

void remove_temporaries(const fs::path& folder) {
    for (const fs::path& temporary : temporaries(folder)) remove_if_abandoned(temporary);
}

}  // namespace mcdem::core
