// A layer over the C library's file operations (LD_PRELOAD) that makes one of them fail, or simulates a
// power cut before it. Operations on files below MCDEM_TEST_FILES are counted from 1:
//   MCDEM_TEST_FAULT_LOG    file to which each operation is appended, as "number kind path"
//   MCDEM_TEST_FAULT_AT     number of the operation that fails
//   MCDEM_TEST_FAULT_KINDS  kinds that are counted, e.g. "open,write"; default: all
//   MCDEM_TEST_FAULT_NAME   counts only paths that contain this text
//   MCDEM_TEST_FAULT        EIO, ENOSPC, EMFILE, ESTALE, EACCES, EINTR; SHORT (transfers half of the bytes);
//                           KILL; CUT (power cut: unsynced data and folder entries are lost);
//                           CUT_DATA (power cut: only unsynced data is lost)
//   MCDEM_TEST_FAULT_STAYS  if set, all later operations fail as well
//   MCDEM_TEST_FAULT_KEPT   folder on the same disk, for files that a power cut restores
#include <sys/uio.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <mutex>

#include "layers/power_cut.h"

namespace {

std::recursive_mutex mutex;

int number_of(const std::string& fault) {
    const std::map<std::string, int> numbers{{"EIO", EIO},       {"ENOSPC", ENOSPC}, {"EMFILE", EMFILE},
                                             {"ESTALE", ESTALE}, {"EINTR", EINTR},   {"EACCES", EACCES}};
    const auto found = numbers.find(fault);
    return found == numbers.end() ? 0 : found->second;
}

void log(long number, const std::string& kind, const std::string& path) {
    REAL(open);
    REAL(write);
    REAL(close);
    const std::string line = std::to_string(number) + " " + kind + " " + path + "\n";
    const int file = real_open(settings().log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    (void)!real_write(file, line.data(), line.size());
    real_close(file);
}

enum class Turn { as_usual, fails, halved };

/// The fate of this operation; errno is set if it fails.
Turn turn_of(const char* kind, const std::string& path) {
    static long count = 0;
    const Settings& now = settings();
    if (!counts(path) || (!now.name.empty() && path.find(now.name) == path.npos)) return Turn::as_usual;
    if (!now.kinds.empty() &&
        ("," + now.kinds + ",").find("," + std::string(kind) + ",") == std::string::npos)
        return Turn::as_usual;
    ++count;
    if (!now.log.empty()) log(count, kind, path);
    if (now.at == 0 || count < now.at || (count > now.at && !now.stays)) return Turn::as_usual;
    if (now.is_cut()) cut_power();
    if (now.fault == "KILL") kill(getpid(), SIGKILL);
    if (now.fault == "SHORT") return Turn::halved;
    errno = number_of(now.fault);
    return Turn::fails;
}

bool fails(const char* kind, const std::string& path) { return turn_of(kind, path) == Turn::fails; }

bool exists(const std::string& path) {
    REAL(lstat);
    struct stat status {};
    return real_lstat(path.c_str(), &status) == 0;
}

template <class Open>
int opened(const std::string& path, int flags, Open open) {
    const std::lock_guard lock(mutex);
    const bool makes = (flags & O_CREAT) != 0 && counts(path) && !exists(path);
    if (fails((flags & O_CREAT) != 0 ? "create" : "open", path)) return -1;
    const int descriptor = open();
    if (descriptor >= 0 && makes && settings().is_cut()) entries.push_back({Entry::made, path, {}, {}, {}});
    if (descriptor >= 0 && makes) note_write(descriptor);
    return descriptor;
}

/// Transfers data by `move(size)`.
template <class Move>
ssize_t moved(const char* kind, int descriptor, std::size_t size, Move move) {
    const std::lock_guard lock(mutex);
    const std::string path = path_of(descriptor);
    if (!counts(path)) return move(size);
    const Turn turn = turn_of(kind, path);
    if (turn == Turn::fails) return -1;
    if (std::strcmp(kind, "write") == 0) note_write(descriptor);
    return move(turn == Turn::halved && size > 1 ? size / 2 : size);
}

template <class Change>
int changed(const char* kind, const std::string& path, Change change) {
    const std::lock_guard lock(mutex);
    if (!counts(path)) return change();
    return fails(kind, path) ? -1 : change();
}

int removed(const std::string& path, bool is_folder, int (*remove)(const std::string&)) {
    const std::lock_guard lock(mutex);
    if (!counts(path)) return remove(path);
    if (fails(is_folder ? "rmdir" : "unlink", path)) return -1;
    const std::string kept = settings().is_cut() && !is_folder ? keep(path) : "";
    const int result = remove(path);
    if (result == 0 && settings().is_cut())
        entries.push_back({is_folder ? Entry::removed_folder : Entry::removed, path, {}, kept, {}});
    return result;
}

int renamed(const std::string& from, const std::string& to,
            int (*rename)(const std::string&, const std::string&)) {
    const std::lock_guard lock(mutex);
    if (!counts(to)) return rename(from, to);
    if (fails("rename", to)) return -1;
    Entry entry{Entry::renamed, to, from, {}, {}};
    if (settings().is_cut()) {
        entry.kept_path = keep(to);
        entry.kept_before = keep(from);
    }
    const int result = rename(from, to);
    if (result == 0 && settings().is_cut()) entries.push_back(entry);
    return result;
}

}  // namespace

#define WITH_MODE(flags, mode)       \
    mode_t mode = 0;                 \
    if ((flags)&O_CREAT) {           \
        va_list more;                \
        va_start(more, flags);       \
        mode = va_arg(more, mode_t); \
        va_end(more);                \
    }

extern "C" {

int open(const char* path, int flags, ...) {
    WITH_MODE(flags, mode)
    REAL(open);
    return opened(path_of(AT_FDCWD, path), flags, [&] { return real_open(path, flags, mode); });
}
int open64(const char* path, int flags, ...) {
    WITH_MODE(flags, mode)
    REAL(open64);
    return opened(path_of(AT_FDCWD, path), flags, [&] { return real_open64(path, flags, mode); });
}
int openat(int folder, const char* path, int flags, ...) {
    WITH_MODE(flags, mode)
    REAL(openat);
    return opened(path_of(folder, path), flags, [&] { return real_openat(folder, path, flags, mode); });
}
int openat64(int folder, const char* path, int flags, ...) {
    WITH_MODE(flags, mode)
    REAL(openat64);
    return opened(path_of(folder, path), flags, [&] { return real_openat64(folder, path, flags, mode); });
}

static FILE* opened_file(const char* path, const char* how, FILE* (*open)(const char*, const char*)) {
    FILE* file = nullptr;
    const int flags = std::strpbrk(how, "wa") ? O_CREAT : 0;
    opened(path_of(AT_FDCWD, path), flags, [&] {
        file = open(path, how);
        return file ? fileno(file) : -1;
    });
    return file;
}
FILE* fopen(const char* path, const char* how) {
    REAL(fopen);
    return opened_file(path, how, real_fopen);
}
FILE* fopen64(const char* path, const char* how) {
    REAL(fopen64);
    return opened_file(path, how, real_fopen64);
}
DIR* opendir(const char* path) {
    REAL(opendir);
    const std::lock_guard lock(mutex);
    return fails("opendir", path_of(AT_FDCWD, path)) ? nullptr : real_opendir(path);
}

int close(int descriptor) {
    REAL(close);
    const int result = changed("close", path_of(descriptor), [] { return 0; });
    const int error = errno;
    const int closed = real_close(descriptor);  // Linux closes the descriptor even if it reports an error
    if (result == 0) return closed;
    errno = error;
    return result;
}
int fclose(FILE* file) {
    REAL(fclose);
    const int result = changed("close", path_of(fileno(file)), [] { return 0; });
    const int error = errno;
    const int closed = real_fclose(file);
    if (result == 0) return closed;
    errno = error;
    return EOF;
}

ssize_t write(int descriptor, const void* from, size_t size) {
    REAL(write);
    return moved("write", descriptor, size, [&](size_t n) { return real_write(descriptor, from, n); });
}
ssize_t pwrite(int descriptor, const void* from, size_t size, off_t first) {
    REAL(pwrite);
    return moved("write", descriptor, size,
                 [&](size_t n) { return real_pwrite(descriptor, from, n, first); });
}
ssize_t pwrite64(int descriptor, const void* from, size_t size, off64_t first) {
    REAL(pwrite64);
    return moved("write", descriptor, size,
                 [&](size_t n) { return real_pwrite64(descriptor, from, n, first); });
}
ssize_t writev(int descriptor, const iovec* from, int count) {
    REAL(write);
    // Only the first one is shortened: callers must handle short transfers.
    while (count > 1 && from->iov_len == 0) ++from, --count;
    return moved("write", descriptor, from->iov_len,
                 [&](size_t n) { return real_write(descriptor, from->iov_base, n); });
}
ssize_t read(int descriptor, void* to, size_t size) {
    REAL(read);
    return moved("read", descriptor, size, [&](size_t n) { return real_read(descriptor, to, n); });
}
ssize_t pread(int descriptor, void* to, size_t size, off_t first) {
    REAL(pread);
    return moved("read", descriptor, size, [&](size_t n) { return real_pread(descriptor, to, n, first); });
}
ssize_t pread64(int descriptor, void* to, size_t size, off64_t first) {
    REAL(pread64);
    return moved("read", descriptor, size, [&](size_t n) { return real_pread64(descriptor, to, n, first); });
}

int fsync(int descriptor) {
    REAL(fsync);
    const std::string path = path_of(descriptor);
    return changed("fsync", path, [&] {
        if (counts(path)) note_sync(descriptor, path);
        return counts(path) ? 0 : real_fsync(descriptor);  // no power cut, so no need to wait for slow disks
    });
}
int ftruncate(int descriptor, off_t size) {
    REAL(ftruncate);
    return changed("ftruncate", path_of(descriptor), [&] {
        note_write(descriptor);
        return real_ftruncate(descriptor, size);
    });
}
int ftruncate64(int descriptor, off64_t size) {
    REAL(ftruncate64);
    return changed("ftruncate", path_of(descriptor), [&] {
        note_write(descriptor);
        return real_ftruncate64(descriptor, size);
    });
}

int rename(const char* from, const char* to) {
    return renamed(path_of(AT_FDCWD, from), path_of(AT_FDCWD, to),
                   [](const std::string& from, const std::string& to) {
                       REAL(rename);
                       return real_rename(from.c_str(), to.c_str());
                   });
}
int link(const char* from, const char* to) {
    REAL(link);
    const std::string path = path_of(AT_FDCWD, to);
    return changed("link", path, [&] {
        const int result = real_link(from, to);
        if (result == 0 && settings().is_cut() && counts(path))
            entries.push_back({Entry::made, path, {}, {}, {}});
        return result;
    });
}
int mkdir(const char* name, mode_t mode) {
    REAL(mkdir);
    const std::string path = path_of(AT_FDCWD, name);
    return changed("mkdir", path, [&] {
        const int result = real_mkdir(name, mode);
        if (result == 0 && settings().is_cut() && counts(path))
            entries.push_back({Entry::made_folder, path, {}, {}, {}});
        return result;
    });
}

static int really_unlink(const std::string& path) {
    REAL(unlink);
    return real_unlink(path.c_str());
}
static int really_rmdir(const std::string& path) {
    REAL(rmdir);
    return real_rmdir(path.c_str());
}
static bool is_folder(const std::string& path) {
    REAL(lstat);
    struct stat status {};
    return real_lstat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode);
}

#define LOOK(name, status_type)                                                                     \
    int name(const char* path, struct status_type* status) {                                        \
        REAL(name);                                                                                 \
        return changed("stat", path_of(AT_FDCWD, path), [&] { return real_##name(path, status); }); \
    }
LOOK(stat, stat)
LOOK(lstat, stat)
LOOK(stat64, stat64)
LOOK(lstat64, stat64)
#define LOOK_AT(name, status_type)                                                  \
    int name(int folder, const char* path, struct status_type* status, int flags) { \
        REAL(name);                                                                 \
        const auto look = [&] { return real_##name(folder, path, status, flags); }; \
        return *path ? changed("stat", path_of(folder, path), look) : look();       \
    }
LOOK_AT(fstatat, stat)
LOOK_AT(fstatat64, stat64)
int unlink(const char* path) { return removed(path_of(AT_FDCWD, path), false, really_unlink); }
int rmdir(const char* path) { return removed(path_of(AT_FDCWD, path), true, really_rmdir); }
int remove(const char* name) {
    const std::string path = path_of(AT_FDCWD, name);
    return is_folder(path) ? removed(path, true, really_rmdir) : removed(path, false, really_unlink);
}
int unlinkat(int folder, const char* name, int flags) {
    const std::string path = path_of(folder, name);
    return (flags & AT_REMOVEDIR) ? removed(path, true, really_rmdir) : removed(path, false, really_unlink);
}
}
