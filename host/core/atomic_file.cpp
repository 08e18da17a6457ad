#include "core/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
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

void replace_file(const std::filesystem::path& file, std::string_view text) {
    replace_file(file, [&](const std::filesystem::path& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        out.write(text.data(), static_cast<std::streamsize>(text.size()));
        out.close();
        if (!out) fail(file, errno);
    });
}

}  // namespace mcdem
