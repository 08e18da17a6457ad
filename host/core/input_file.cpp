#include "core/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "core/errors.h"

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
    while (true) {
        const ssize_t some = ::read(in.number, block, sizeof block);
        if (some < 0 && errno == EINTR) continue;
        if (some < 0) fail_reading(file.string() + ": cannot be read", errno);
        if (some == 0) return;
        take({block, static_cast<std::size_t>(some)});
    }
}

std::string read_file(const std::filesystem::path& file) {
    std::string bytes;
    read_blocks(file, [&](std::string_view block) { bytes += block; });
    return bytes;
}

std::string read_file(const std::filesystem::path& file, std::string_view if_missing) {
    std::error_code unknown;
    if (!std::filesystem::exists(file, unknown) && !unknown)
        throw InputError(file.string() + ": " + std::string(if_missing));
    return read_file(file);
}

}  // namespace mcdem::core
