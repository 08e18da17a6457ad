// Failing standard streams: a full disk, a closed pipe, a lost terminal. Messages that cannot be written are
// ignored; results that cannot be printed set the exit code to 1.
#pragma once
#include <fmt/format.h>

#include <cstdio>
#include <span>
#include <string>
#include <string_view>

namespace mcdem::inline cli {

/// Must be called first. Reserves the descriptors of closed streams, so that files opened later do not get
/// them. Ignores signals caused by writes to a closed pipe or beyond the limit of the file size.
void set_up_streams();

/// Writes as much as possible and ignores errors.
void write_text(std::FILE* out, std::string_view text);

/// Puts blanks in place of control characters, except line breaks and tabs: names come from files of others
/// and must not control a terminal.
void blank_control(std::span<char> text);

/// Prints results on standard output, without control characters.
template <class... T>
void print_out(fmt::format_string<T...> format, T&&... values) {
    std::string text = fmt::format(format, std::forward<T>(values)...);
    blank_control(text);
    write_text(stdout, text);
}

/// Final exit code of a command with this exit code: exit_failed, with a message, if standard output has
/// failed and is not a lost terminal.
int exit_code_of_output(int exit_code);

}  // namespace mcdem::cli
