// Text in tables that spreadsheets open.
#pragma once
#include <charconv>
#include <string>
#include <string_view>

#include "core/replaced.h"

namespace mcdem::inline core {

/// Whether the whole text is one number, such as -0.5 or 1e-3.
inline bool is_number(std::string_view text) {
    if (text.find_first_not_of("0123456789+-.eE") != text.npos) return false;  // nan, inf
    if (text.starts_with('+')) text.remove_prefix(1);
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc{} && end == text.data() + text.size();
}

/// A spreadsheet takes text that begins with one of = + - @, also after blanks, for a formula, and runs it.
/// Such text gets an apostrophe in front, by which spreadsheets mark text; numbers stay.
inline std::string without_formula(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r\n\"");
    const bool is_formula =
        first != text.npos && std::string_view("=+-@").find(text[first]) != std::string_view::npos;
    return (is_formula && !is_number(text) ? "'" : "") + std::string(text);
}

/// A quoted cell, on one line; never a formula.
inline std::string csv_cell(std::string_view text) {
    return '"' + replaced(without_formula(text), {{'"', "\"\""}, {'\n', " "}, {'\r', " "}}) + '"';
}

}  // namespace mcdem::core
