#include "core/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <span>
#include <system_error>

#include "core/errors.h"
#include "core/look.h"

namespace mcdem::inline core {
namespace {

/// A file descriptor that is closed by its owner.
struct Descriptor {
    int number;
    ~Descriptor() { ::close(number); }
};

void expect_regular(const std::filesystem::path& file, int descriptor) {
    struct stat status {};
    if (::fstat(descriptor, &status) != 0) {
        const int error = errno;
        ::close(descriptor);
        fail_reading(file.string() + ": cannot be opened", error);
    }
    if (S_ISREG(status.st_mode)) return;
    ::close(descriptor);
    throw InputError(file.string() + (S_ISDIR(status.st_mode) ? ": is a folder; give a file"
                                                              : ": is a pipe or device; give a file"));
}

/// Reads as much as there is, at most as much as fits; 0 at the end.
std::size_t read_some(const std::filesystem::path& file, int descriptor, std::span<char> block) {
    ssize_t some = 0;
    do some = ::read(descriptor, block.data(), block.size());
    while (some < 0 && errno == EINTR);
    if (some < 0) fail_reading(file.string() + ": cannot be read", errno);
    return static_cast<std::size_t>(some);
}

}  // namespace

void fail_reading(const std::string& what, int error) {
    throw RunError(what + ": " + std::generic_category().message(error) +
                   "; the file may be intact: remove the cause and try again");
}

int open_input(const std::filesystem::path& file) {
    int descriptor = -1;
    // O_NONBLOCK: opening a pipe would otherwise wait for a writer.
    do descriptor = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    while (descriptor < 0 && errno == EINTR);
    if (descriptor < 0) {
        if (errno == ENOENT || errno == ENOTDIR) throw InputError(file.string() + ": no such file");
        if (errno == ENXIO) throw InputError(file.string() + ": is a socket or device; give a file");
        fail_reading(file.string() + ": cannot be opened", errno);
    }
    expect_regular(file, descriptor);
    return descriptor;
}

void read_blocks(const std::filesystem::path& file, const std::function<void(std::string_view block)>& take) {
    const Descriptor in{open_input(file)};
    char block[65536];
    while (const std::size_t some = read_some(file, in.number, block)) take({block, some});
}

std::string read_beginning(const std::filesystem::path& file, std::size_t size) {
    const Descriptor in{open_input(file)};
    std::string bytes(size, '\0');
    std::size_t count = 0;
    while (const std::size_t some = read_some(file, in.number, std::span(bytes).subspan(count)))
        count += some;
    bytes.resize(count);
    return bytes;
}

std::string read_file(const std::filesystem::path& file) {
    std::string bytes;
    read_blocks(file, [&](std::string_view block) { bytes += block; });
    return bytes;
}

std::string read_file(const std::filesystem::path& file, std::string_view if_missing) {
    if (!is_there(file)) throw InputError(file.string() + ": " + std::string(if_missing));
    return read_file(file);
}

}  // namespace mcdem::core
