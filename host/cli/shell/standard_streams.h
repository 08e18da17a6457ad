// Standard output and error that fail: a full disk, a closed pipe, a terminal that is gone. Messages that
// cannot be written end nothing; results that cannot be printed make the exit code 1.
#pragma once
#include <fmt/format.h>

#include <cstdio>
#include <string_view>

namespace mcdem::inline cli {

/// Must come first. No file that is opened later gets the number of a stream that was closed, and no write
/// ends the program by a signal: neither to a pipe whose reader has gone, nor past a limit of the file size.
void set_up_streams();

/// Writes as much as can be written, and says nothing of the rest.
void write_text(std::FILE* out, std::string_view text);

/// Results, on standard output.
template <class... T>
void print_out(fmt::format_string<T...> format, T&&... values) {
    write_text(stdout, fmt::format(format, std::forward<T>(values)...));
}

/// The exit code of a command that had this one, once all is printed: exit_failed, with a message, where
/// standard output has failed and is not a terminal that has gone.
int exit_code_of_output(int exit_code);

}  // namespace mcdem::cli
