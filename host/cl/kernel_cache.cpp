#include "cl/kernel_cache.h"

#include <elf.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
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

template <class Value>
std::optional<Value> read_at(std::ifstream& file, std::uint64_t offset) {
    Value value;
    file.seekg(static_cast<std::streamoff>(offset));
    if (!file.read(reinterpret_cast<char*>(&value), sizeof value)) return std::nullopt;
    return value;
}

/// Whether the table of sections at the end of a shared object is complete.
bool is_whole_shared_object(const fs::path& path, std::uint64_t size) {
    std::ifstream file(path, std::ios::binary);
    const auto header = read_at<Elf64_Ehdr>(file, 0);
    if (!header || std::memcmp(header->e_ident, ELFMAG, SELFMAG) != 0) return false;
    if (header->e_ident[EI_CLASS] != ELFCLASS64) return true;
    return header->e_shoff > 0 &&
           header->e_shoff + std::uint64_t(header->e_shnum) * header->e_shentsize <= size;
}

/// LLVM bitcode: four letters, then blocks with a start word and a length in words.
bool is_whole_bitcode(const fs::path& path, std::uint64_t size) {
    std::ifstream file(path, std::ios::binary);
    const auto letters = read_at<std::uint32_t>(file, 0);
    if (!letters || *letters != 0xdec04342) return false;
    std::uint64_t at = 4;
    while (at < size) {
        const auto words = read_at<std::uint32_t>(file, at + 4);
        if (!words) return false;
        at += 8 + 4 * std::uint64_t(*words);
    }
    return at == size;
}

/// A file that PoCL will rename when it is complete; another process may be writing it.
bool is_temporary(const fs::path& path) { return path.filename().string().starts_with("tempfile"); }

/// PoCL leaves an empty temporary file per process. Files with content are not removed: the folder may be one
/// that other programs use.
bool is_left_over(const fs::path& temporary) {
    std::error_code error;
    const bool empty = fs::is_empty(temporary, error);
    if (error || !empty) return false;
    const auto written = fs::last_write_time(temporary, error);
    return !error && fs::file_time_type::clock::now() - written > std::chrono::days(1);
}

bool is_damaged(const fs::path& path) {
    std::error_code gone;  // another process may remove files at the same time
    const std::uint64_t size = fs::file_size(path, gone);
    if (gone) return false;
    if (path.extension() == ".so") return !is_whole_shared_object(path, size);
    return path.filename() == "program.bc" && !is_whole_bitcode(path, size);
}

void remove_useless_files(const fs::path& folder) {
    std::error_code error;
    for (auto entry = fs::recursive_directory_iterator(folder, error);
         !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
        std::error_code gone;
        const fs::path& path = entry->path();
        if (!entry->is_regular_file(gone)) continue;
        if (is_temporary(path) ? is_left_over(path) : is_damaged(path)) fs::remove(path, gone);
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
        remove_useless_files(kernel_cache_folder());
        return true;
    }();
    (void)once;
}

}  // namespace mcdem::opencl
