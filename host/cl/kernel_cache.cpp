#include "cl/kernel_cache.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <optional>

namespace mcdem::inline opencl {
namespace {

namespace fs = std::filesystem;

constexpr mode_t by_others = 022, entry_of_others = 011;
constexpr const char* nowhere = "/dev/null/no-folder-for-kernels";  ///< PoCL then offers no device

fs::path variable(const char* name) {
    const char* text = std::getenv(name);
    return text ? text : "";
}

bool can_write_in(const fs::path& folder) {
    std::string probe = (folder / "mcdem-probe-XXXXXX").string();
    const int file = mkstemp(probe.data());
    if (file < 0) return false;
    close(file);
    unlink(probe.c_str());
    return true;
}

/// Makes the folder and those above it, for this user alone.
void make_private(const fs::path& folder) {
    fs::path path;
    for (const fs::path& part : folder) {
        path /= part;
        ::mkdir(path.c_str(), 0700);
    }
}

bool is_trusted(uid_t owner) {
    struct stat root {};
    // In a container, root's files may appear as those of another user.
    return owner == geteuid() || owner == 0 || (lstat("/", &root) == 0 && owner == root.st_uid);
}

/// Whether an entry of PoCL's cache, or one below it, is a link, of another user, or, where others can come,
/// can be written by them.
bool is_foreign(const fs::path& entry, bool others_come) {
    struct stat what {};
    if (lstat(entry.c_str(), &what) != 0) return errno != ENOENT;
    if (what.st_uid != geteuid() || S_ISLNK(what.st_mode)) return true;
    if (others_come && (what.st_mode & by_others) != 0) return true;
    if (!S_ISDIR(what.st_mode)) return false;
    std::error_code error;
    const bool below = others_come && (what.st_mode & entry_of_others) != 0;
    for (auto each = fs::directory_iterator(entry, error); !error && each != fs::directory_iterator();
         each.increment(error))
        if (is_foreign(each->path(), below)) return true;
    return error && error.value() != ENOENT;
}

/// The first entry with compiled kernels that may be of others.
std::optional<fs::path> foreign_kernels(const fs::path& folder, bool others_come) {
    constexpr std::size_t name_of_kernels = 2;  // of a folder: the first letters of a digest
    std::error_code error;
    for (auto each = fs::directory_iterator(folder, error); !error && each != fs::directory_iterator();
         each.increment(error))
        if (each->path().filename().string().size() == name_of_kernels &&
            is_foreign(each->path(), others_come))
            return each->path();
    return error ? std::optional(folder) : std::nullopt;
}

bool is_ours_alone(const fs::path& folder) {
    struct stat what {};
    return lstat(folder.c_str(), &what) == 0 && S_ISDIR(what.st_mode) && what.st_uid == geteuid() &&
           (what.st_mode & 077) == 0;
}

bool is_usable(const fs::path& folder) {
    return is_ours_alone(folder) && why_open_to_others(folder).empty() && can_write_in(folder);
}

/// `mcdem-kernels-UID` in the temporary directory, or, if others have made that, one with a random ending.
/// Several processes may make it at the same time.
std::optional<fs::path> private_folder() {
    std::error_code error;
    const fs::path temporary = fs::canonical(fs::temp_directory_path(error), error);
    if (error) return std::nullopt;
    const std::string name = fmt::format("mcdem-kernels-{}", geteuid());
    mkdir((temporary / name).c_str(), 0700);
    if (is_usable(temporary / name)) return temporary / name;
    for (auto each = fs::directory_iterator(temporary, error); !error && each != fs::directory_iterator();
         each.increment(error))
        if (each->path().filename().string().starts_with(name + "-") && is_usable(each->path()))
            return each->path();
    std::string other = (temporary / (name + "-XXXXXX")).string();
    if (mkdtemp(other.data()) && is_usable(other)) return other;
    return std::nullopt;
}

/// The folder of the environment, without links; nothing if it cannot be used.
std::optional<fs::path> wanted_folder() {
    const fs::path wanted = wanted_kernel_cache();
    if (wanted.empty()) return std::nullopt;
    make_private(wanted);
    std::error_code error;
    const fs::path folder = fs::canonical(wanted, error);
    if (error || !can_write_in(folder)) return std::nullopt;
    const std::string why = why_open_to_others(folder);
    if (why.empty()) return folder;
    kernel_cache_refused(why);
    return std::nullopt;
}

/// PoCL leaves an empty temporary file per process, and may still write to a new one. Files with content are
/// not removed: the folder may be one that other programs use.
void remove_left_overs(const fs::path& folder) {
    const auto yesterday = fs::file_time_type::clock::now() - std::chrono::days(1);
    std::error_code error;
    for (auto entry = fs::directory_iterator(folder, error); !error && entry != fs::directory_iterator();
         entry.increment(error)) {
        std::error_code gone;  // another process may remove files at the same time
        const fs::path& path = entry->path();
        if (path.filename().string().starts_with("tempfile") && entry->is_regular_file(gone) &&
            entry->file_size(gone) == 0 && entry->last_write_time(gone) < yesterday && !gone)
            fs::remove(path, gone);
    }
}

}  // namespace

std::string why_open_to_others(const fs::path& folder) {
    for (fs::path path = folder;; path = path.parent_path()) {
        struct stat what {};
        if (lstat(path.c_str(), &what) != 0 || !S_ISDIR(what.st_mode))
            return fmt::format(
                "{}: must be a folder, of which only this user can change the compiled kernels",
                path.string());
        const bool is_own = path == folder ? what.st_uid == geteuid() : is_trusted(what.st_uid);
        if (!is_own)
            return fmt::format(
                "{}: belongs to the user {}, who could put code of theirs into compiled kernels: set "
                "POCL_CACHE_DIR to a folder of your own",
                path.string(), what.st_uid);
        if ((what.st_mode & by_others) != 0 && (path == folder || (what.st_mode & S_ISVTX) == 0))
            return fmt::format(
                "{0}: others can write there (mode {1:04o}), and put code of theirs into compiled "
                "kernels: `chmod go-w {0}`, or set POCL_CACHE_DIR to a folder of your own",
                path.string(), what.st_mode & 07777);
        if (path == folder)
            if (const auto foreign = foreign_kernels(folder, (what.st_mode & entry_of_others) != 0))
                return fmt::format("{}: may hold compiled kernels of others: remove it, and it is made again",
                                   foreign->string());
        if (!path.has_relative_path()) return {};
    }
}

fs::path user_cache() {
    if (const fs::path folder = variable("XDG_CACHE_HOME"); folder.is_absolute()) return folder;
    std::error_code missing;
    const fs::path home = variable("HOME");  // not made: users of services have one that does not exist
    return home.is_absolute() && fs::is_directory(home, missing) ? home / ".cache" : fs::path();
}

fs::path wanted_kernel_cache() {
    if (const fs::path folder = variable("POCL_CACHE_DIR"); !folder.empty()) return fs::absolute(folder);
    const fs::path cache = user_cache();
    return cache.empty() ? cache : cache / "pocl/kcache";
}

void prepare_kernel_cache() {
    static const bool once = [] {
        setenv("PATH", "/usr/bin:/bin", 0);  // without PATH, PoCL finds no linker and aborts
        auto folder = wanted_folder();
        if (!folder) folder = private_folder();
        setenv("POCL_CACHE_DIR", folder ? folder->c_str() : nowhere, 1);
        if (folder) remove_left_overs(*folder);
        return true;
    }();
    (void)once;
}

}  // namespace mcdem::opencl
