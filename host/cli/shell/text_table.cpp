#include "cli/shell/text_table.h"

#include <algorithm>

#include "core/replaced.h"

namespace mcdem::inline cli {
namespace {

using Cells = std::vector<std::string>;

/// Without line breaks and control characters, so that a label from a file cannot control a terminal or break
/// a table.
std::string one_line(std::string text) {
    std::ranges::replace_if(
        text, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
    return text;
}

std::string escaped(const std::string& text) {
    return replaced(text,
                    {{'|', "\\|"}, {'\\', "\\\\"}, {'`', "\\`"}, {'*', "\\*"}, {'[', "\\["}, {'<', "\\<"}});
}

Cells prepared(const Cells& cells, TableFormat format) {
    Cells result;
    for (const auto& cell : cells)
        result.push_back(format == TableFormat::markdown ? escaped(one_line(cell)) : one_line(cell));
    return result;
}

/// Number of characters of a UTF-8 text, each assumed to be one column wide.
std::size_t width_of(const std::string& text) {
    return std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; });
}

std::string padded(const std::string& cell, std::size_t width, Align align) {
    const std::string blanks(width - std::min(width, width_of(cell)), ' ');
    return align == Align::left ? cell + blanks : blanks + cell;
}

std::string rule_of(std::size_t width, Align align, TableFormat format) {
    if (format == TableFormat::terminal) {
        std::string rule;
        for (std::size_t i = 0; i < width; ++i) rule += "─";
        return rule;
    }
    const std::string dashes(width - 1, '-');
    return align == Align::left ? ":" + dashes : dashes + ":";
}

std::string line_of(const Cells& cells, TableFormat format) {
    std::string line = format == TableFormat::markdown ? "|" : "";
    for (std::size_t c = 0; c < cells.size(); ++c)
        line += format == TableFormat::markdown ? " " + cells[c] + " |" : (c ? "  " : "") + cells[c];
    line.erase(line.find_last_not_of(' ') + 1);
    return line + "\n";
}

}  // namespace

std::string to_text(const TextTable& table, TableFormat format) {
    std::vector<Cells> lines(1);
    for (const auto& column : table.columns) lines[0].push_back(column.title);
    lines[0] = prepared(lines[0], format);
    for (const auto& row : table.rows) lines.push_back(prepared(row, format));

    Cells rule;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
        std::size_t width = 3;
        for (const auto& line : lines) width = std::max(width, width_of(line[c]));
        for (auto& line : lines) line[c] = padded(line[c], width, table.columns[c].align);
        rule.push_back(rule_of(width, table.columns[c].align, format));
    }
    lines.insert(lines.begin() + 1, rule);

    std::string text;
    for (const auto& line : lines) text += line_of(line, format);
    if (!table.notes.empty()) text += "\n";
    for (const auto& note : prepared(table.notes, format))
        text += (format == TableFormat::markdown ? "- " : "  ") + note + "\n";
    return text;
}

}  // namespace mcdem::cli
