#include "core/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <fstream>
#include <random>
#include <system_error>

#include "core/errors.h"

namespace mcdem {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, int error) {
    throw RunError(file.string() + ": cannot be written: " + std::generic_category().message(error));
}

void force_to_disk(const std::filesystem::path& file, int flags) {
    const int descriptor = ::open(file.c_str(), flags | O_CLOEXEC);
    if (descriptor < 0) fail(file, errno);
    const int result = ::fsync(descriptor);
    const int error = errno;
    ::close(descriptor);
    // Some file systems cannot sync (EINVAL, EROFS on folders): nothing more can be done there.
    if (result != 0 && error != EINVAL && error != EROFS) fail(file, error);
}

/// Beside the file, and no other program's.
std::filesystem::path own_temporary(const std::filesystem::path& file) {
    thread_local std::mt19937_64 random{(std::uint64_t{std::random_device{}()} << 32) ^
                                        std::random_device{}()};
    std::filesystem::path temporary = file;
    temporary += fmt::format(".{:016x}.tmp", random());
    return temporary;
}

void write_text(const std::filesystem::path& file, std::string_view text) {
    std::ofstream out(file, std::ios::binary);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.close();
    if (!out) {
        const int error = errno;
        std::error_code ignored;
        std::filesystem::remove(file, ignored);
        fail(file, error);
    }
}

void replace_by(const std::filesystem::path& file, const std::filesystem::path& temporary,
                const std::function<void(const std::filesystem::path& temporary)>& write) {
    try {
        write(temporary);
        force_to_disk(temporary, O_RDONLY);
        move_file(temporary, file);
    } catch (...) {
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        throw;
    }
}

}  // namespace

void move_file(const std::filesystem::path& from, const std::filesystem::path& to) {
    std::error_code error;
    std::filesystem::rename(from, to, error);
    if (error) fail(to, error.value());
    const auto folder = to.parent_path();
    force_to_disk(folder.empty() ? "." : folder, O_RDONLY | O_DIRECTORY);
}

void replace_file(const std::filesystem::path& file,
                  const std::function<void(const std::filesystem::path& temporary)>& write) {
    std::filesystem::path temporary = file;
    temporary += ".tmp";
    replace_by(file, temporary, write);
}

void replace_file(const std::filesystem::path& file, std::string_view text) {
    replace_by(file, own_temporary(file),
               [&](const std::filesystem::path& temporary) { write_text(temporary, text); });
}

bool create_file(const std::filesystem::path& file, std::string_view text) {
    const std::filesystem::path temporary = own_temporary(file);
    write_text(temporary, text);
    int error = ::link(temporary.c_str(), file.c_str()) == 0 ? 0 : errno;
    // A network file system may have made the link and lost the answer.
    if (error == EEXIST && std::filesystem::hard_link_count(temporary) == 2) error = 0;
    if (error == EPERM || error == ENOSYS || error == EOPNOTSUPP) {
        // A file system without links: all that is lost is the order of two programs within a moment.
        error = std::filesystem::exists(file) ? EEXIST : 0;
        if (error == 0) move_file(temporary, file);
    }
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    if (error != 0 && error != EEXIST) fail(file, error);
    return error == 0;
}

}  // namespace mcdem
