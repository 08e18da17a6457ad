#include "scene/foreign_table.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "core/errors.h"
#include "core/input_file.h"
#include "scene/read_packing.h"
#include "scene/text_lines.h"

namespace mcdem {
namespace {

namespace fs = std::filesystem;

/// The file's bytes, unpacked where it is packed.
std::string bytes_of(const fs::path& file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error))
        throw InputError(
            fmt::format("{}: must be a table, got {}", file.string(),
                        fs::exists(file, error) ? "something that is not a file" : "no such file"));
    const gzFile in = gzdopen(open_input(file), "rb");
    if (!in) throw std::bad_alloc();
    std::string bytes, problem;
    int count = 0;
    for (char buffer[1 << 16]; problem.empty() && (count = gzread(in, buffer, sizeof buffer)) > 0;) {
        bytes.append(buffer, static_cast<std::size_t>(count));
        if (bytes.size() > largest_foreign_table)
            problem = "must have at most 1 GiB, got more: leave out frames, or split it into several files";
    }
    int code = Z_OK;
    const std::string reason = gzerror(in, &code);
    const int system = errno;
    if (code == Z_ERRNO) {
        gzclose(in);
        fail_reading(file.string() + ": cannot be read", system);
    }
    if (problem.empty() && (count < 0 || code != Z_OK))
        problem = fmt::format("must be whole, got one that cannot be unpacked ({}): pack it again with gzip",
                              reason);
    gzclose(in);
    if (!problem.empty()) throw InputError(file.string() + ": " + problem);
    return bytes;
}

bool is_utf8(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const std::size_t more = byte < 0x80                   ? 0
                                 : byte >= 0xC2 && byte < 0xE0 ? 1
                                 : byte >= 0xE0 && byte < 0xF0 ? 2
                                                               : 3;
        if (byte >= 0x80 && (byte < 0xC2 || byte > 0xF4)) return false;
        for (std::size_t k = 1; k <= more; ++k)
            if (i + k >= text.size() || (static_cast<unsigned char>(text[i + k]) & 0xC0) != 0x80)
                return false;
        const auto next = more > 0 ? static_cast<unsigned char>(text[i + 1]) : 0;
        if ((byte == 0xE0 && next < 0xA0) || (byte == 0xED && next > 0x9F) || (byte == 0xF0 && next < 0x90) ||
            (byte == 0xF4 && next > 0x8F))
            return false;  // longer than needed, half of a pair, or beyond Unicode
        i += more + 1;
    }
    return true;
}

/// ISO 8859-1 in UTF-8: what European spreadsheets write where they do not write UTF-8.
std::string from_latin1(std::string_view text) {
    std::string utf8;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= 0x80) utf8 += static_cast<char>(0xC0 | (byte >> 6));
        utf8 += byte < 0x80 ? c : static_cast<char>(0x80 | (byte & 0x3F));
    }
    return utf8;
}

/// LAMMPS data files: read as packings are, then told again as columns.
bool looks_like_data(std::string_view text) {
    TextLines lines(text.substr(0, 100'000));
    std::vector<std::string_view> words;
    lines.next();  // a title
    bool counted = false;
    while (const auto line = lines.next()) {
        split_at_blanks(line->substr(0, std::min(line->find('#'), line->size())), words);
        counted = counted || (words.size() == 2 && words[1] == "atoms");
        if (counted && words.size() == 1 && words[0] == "Atoms") return true;
    }
    return false;
}

void parse_data(ForeignTable& table) {
    std::istringstream input(table.text);
    const Packing packing = read_lammps_packing(input, table.file);
    table.text.clear();
    std::vector<std::size_t> ends;
    for (std::size_t i = 0; i < packing.size(); ++i) {
        const Vec3& at = packing.position[i];
        for (const double value : {at.x(), at.y(), at.z(), packing.diameter[i]}) {
            table.text += fmt::format("{}", value);
            ends.push_back(table.text.size());
        }
    }
    table.name_columns({"x", "y", "z", "diameter"}, 4);
    std::size_t first = 0;
    for (std::size_t i = 0; i < packing.size(); ++i) {
        std::vector<std::string_view> cells;
        for (std::size_t k = 0; k < 4; ++k) {
            cells.push_back(std::string_view(table.text).substr(first, ends[4 * i + k] - first));
            first = ends[4 * i + k];
        }
        table.add_row(cells);
    }
}

}  // namespace

std::string_view ForeignTable::cell(std::size_t row, std::size_t column) const {
    const Cell& cell = cells_[row * columns.size() + column];
    return std::string_view(text).substr(cell.first, cell.size);
}

std::optional<double> ForeignTable::number(std::size_t row, std::size_t column) const {
    const std::string_view word = cell(row, column);
    if (form.decimal == '.' || word.find(',') == word.npos) return to_number(word);
    std::string point(word.substr(0, 64));
    std::ranges::replace(point, ',', '.');
    return word.find('.') == word.npos && word.size() <= 64 ? to_number(point) : std::nullopt;
}

std::optional<std::size_t> ForeignTable::find(std::string_view name) const {
    const auto found = std::ranges::find(columns, name);
    if (found != columns.end()) return static_cast<std::size_t>(found - columns.begin());
    if (!name.starts_with("column ")) return std::nullopt;
    const auto number = to_whole_number(name.substr(7));
    if (!number || *number < 1 || *number > static_cast<long>(columns.size())) return std::nullopt;
    return static_cast<std::size_t>(*number - 1);
}

std::string ForeignTable::where(std::size_t row) const {
    if (format == TableFormat::data) return file;  // whose lines were read before
    const std::size_t first = cells_[row * columns.size()].first;
    return fmt::format("{}:{}", file, 1 + std::ranges::count(text.substr(0, first), '\n'));
}

void ForeignTable::add_row(const std::vector<std::string_view>& cells) {
    for (const std::string_view cell : cells)
        cells_.push_back(
            {static_cast<std::uint32_t>(cell.data() - text.data()), static_cast<std::uint32_t>(cell.size())});
}

/// Names that are missing, were there before or begin with a question mark or a minus, which a mapping keeps
/// for what is not confirmed and what counts the other way, give way to the column's number.
void ForeignTable::name_columns(const std::vector<std::string>& names, std::size_t count) {
    std::set<std::string> taken;
    columns.clear();
    for (std::size_t i = 0; i < count; ++i) {
        std::string name = i < names.size() ? std::string(without_blanks(names[i])) : std::string();
        if (name.empty() || name.front() == '?' || name.front() == '-' || !taken.insert(name).second)
            name = fmt::format("column {}", i + 1);
        taken.insert(name);
        columns.push_back(std::move(name));
    }
    named = !names.empty();
}

ForeignTable parse_foreign_table(std::string bytes, const std::string& file,
                                 const std::optional<TextForm>& form) {
    FileProblems problems(file);
    ForeignTable table;
    table.file = file;
    if (bytes.starts_with("\xEF\xBB\xBF")) bytes.erase(0, 3);
    table.text = is_utf8(bytes) ? std::move(bytes) : from_latin1(bytes);
    if (table.text.find('\0') != table.text.npos)
        problems.add("must be text, got zero bytes: save it as text in UTF-8");
    else if (looks_like_dump(table.text))
        parse_dump(table, problems);
    else if (looks_like_vtk(table.text))
        parse_vtk(table, problems);
    else if (looks_like_data(table.text))
        table.format = TableFormat::data, parse_data(table);
    else
        parse_text(table, form, problems);
    problems.report();
    return table;
}

ForeignTable read_foreign_table(const fs::path& file, const std::optional<TextForm>& form) {
    return parse_foreign_table(bytes_of(file), file.string(), form);
}

}  // namespace mcdem
