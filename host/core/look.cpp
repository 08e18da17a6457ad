#include "core/look.h"

#include <sys/stat.h>

#include <cerrno>
#include <system_error>

#include "core/input_file.h"

namespace mcdem::inline core {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_looking(const fs::path& path, int error) {
    fail_reading(path.string() + ": cannot be looked at", error);
}

/// `call` is stat or lstat.
template <class Call>
At look(const fs::path& path, Call call) {
    struct stat what {};
    int result = 0;
    do result = call(path.c_str(), &what);
    while (result != 0 && errno == EINTR);
    if (result != 0 && (errno == ENOENT || errno == ENOTDIR)) return At::nothing;
    if (result != 0) fail_looking(path, errno);
    if (S_ISREG(what.st_mode)) return At::file;
    if (S_ISDIR(what.st_mode)) return At::folder;
    return S_ISLNK(what.st_mode) ? At::link : At::other;
}

}  // namespace

At look_at(const fs::path& path) {
    return look(path, [](const char* name, struct stat* what) { return ::stat(name, what); });
}

At look_at_itself(const fs::path& path) {
    return look(path, [](const char* name, struct stat* what) { return ::lstat(name, what); });
}

std::uintmax_t size_of_file(const fs::path& file) {
    std::error_code error;
    const auto size = fs::file_size(file, error);
    if (error) fail_looking(file, error.value());
    return size;
}

std::vector<fs::path> entries_of(const fs::path& folder) {
    std::vector<fs::path> entries;
    std::error_code error;
    auto entry = fs::directory_iterator(folder, error);
    for (; !error && entry != fs::directory_iterator(); entry.increment(error))
        entries.push_back(entry->path());
    if (error) fail_reading(folder.string() + ": its files cannot be listed", error.value());
    return entries;
}

}  // namespace mcdem::core
