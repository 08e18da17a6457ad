#include "cli/shell/standard_streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <iostream>
#include <system_error>

#include "cli/shell/commands.h"
#include "cli/shell/messages.h"

namespace mcdem::inline cli {
namespace {

bool was_terminal = false;
int output_error = 0;  ///< errno of the first failed write to standard output

}  // namespace

void set_up_streams() {
    // Opened in the wrong direction, so that using it still fails.
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF)
            ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
    was_terminal = ::isatty(STDOUT_FILENO) == 1;
}

void write_text(std::FILE* out, std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), out) != text.size() && out == stdout && output_error == 0)
        output_error = errno;
}

void blank_control(std::span<char> text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const bool wanted = byte == '\n' || byte == '\t' || (byte >= 0x20 && byte != 0x7f);
        if (!wanted) text[i] = ' ';
        // U+0080 to U+009F: some terminals take U+009B for the begin of a command.
        if (byte == 0xc2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xa0)
            text[i] = text[i + 1] = ' ';
    }
}

int exit_code_of_output(int exit_code) {
    errno = 0;
    std::cout.flush();  // CLI11 prints help there
    if ((std::fflush(stdout) != 0 || !std::cout) && output_error == 0) output_error = errno;
    if ((output_error == 0 && std::ferror(stdout) == 0) || was_terminal) return exit_code;
    spdlog::error("standard output cannot be written: {}",
                  output_error ? std::generic_category().message(output_error) : "what was printed is lost");
    return std::max(exit_code, exit_failed);
}

}  // namespace mcdem::cli
