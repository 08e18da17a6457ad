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

/// Bytes of a character in UTF-8 that the text begins with and that does something instead of being shown, or
/// 0: U+0080 to U+009F, of which some terminals take U+009B for the begin of a command, separators of lines
/// and paragraphs, and characters that change the direction of the text around them.
std::size_t hidden_sequence(std::string_view text) {
    const auto is = [&](std::string_view lead, unsigned char first, unsigned char last) {
        if (!text.starts_with(lead) || text.size() <= lead.size()) return false;
        const auto byte = static_cast<unsigned char>(text[lead.size()]);
        return byte >= first && byte <= last;
    };
    if (is("\xc2", 0x80, 0x9f) || is("\xd8", 0x9c, 0x9c)) return 2;
    const bool is_hidden =
        is("\xe2\x80", 0x8e, 0x8f) || is("\xe2\x80", 0xa8, 0xae) || is("\xe2\x81", 0xa6, 0xa9);
    return is_hidden ? 3 : 0;
}

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
        if (const std::size_t size = hidden_sequence({text.data() + i, text.size() - i}))
            std::fill_n(text.begin() + static_cast<std::ptrdiff_t>(i), size, ' ');
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
