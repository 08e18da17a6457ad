#include "cl/kernel_cache.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <optional>

namespace mcdem::inline opencl {
namespace {

namespace fs = std::filesystem;

bool can_write_in(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    std::string probe = (folder / "mcdem-probe-XXXXXX").string();
    const int file = mkstemp(probe.data());
    if (file < 0) return false;
    close(file);
    unlink(probe.c_str());
    return true;
}

/// Whether the folder belongs to this user and nobody else can write to it.
bool is_ours_alone(const fs::path& folder) {
    struct stat what {};
    return lstat(folder.c_str(), &what) == 0 && S_ISDIR(what.st_mode) && what.st_uid == geteuid() &&
           (what.st_mode & 077) == 0;
}

std::optional<fs::path> private_folder() {
    std::error_code error;
    const fs::path temporary = fs::temp_directory_path(error);
    if (error) return std::nullopt;
    const fs::path usual = temporary / fmt::format("mcdem-kernels-{}", geteuid());
    mkdir(usual.c_str(), 0700);
    if (is_ours_alone(usual) && can_write_in(usual)) return usual;
    std::string other = (temporary / "mcdem-kernels-XXXXXX").string();
    return mkdtemp(other.data()) ? std::optional<fs::path>(other) : std::nullopt;
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

fs::path kernel_cache_folder() {
    const auto absolute = [](const char* variable) -> std::optional<fs::path> {
        const char* value = std::getenv(variable);
        return value && *value == '/' ? std::optional<fs::path>(value) : std::nullopt;
    };
    if (const auto folder = absolute("POCL_CACHE_DIR")) return *folder;
    if (const auto folder = absolute("XDG_CACHE_HOME")) return *folder / "pocl/kcache";
    if (const auto folder = absolute("HOME")) return *folder / ".cache/pocl/kcache";
    return "/tmp/pocl/kcache";
}

void prepare_kernel_cache() {
    static const bool once = [] {
        setenv("PATH", "/usr/bin:/bin", 0);  // without PATH, PoCL finds no linker and aborts
        if (!can_write_in(kernel_cache_folder()))
            if (const auto folder = private_folder()) setenv("POCL_CACHE_DIR", folder->c_str(), 1);
        remove_left_overs(kernel_cache_folder());
        return true;
    }();
    (void)once;
}

}  // namespace mcdem::opencl
