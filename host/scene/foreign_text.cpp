// Text in rows and columns, cut by commas, semicolons, tabs or blanks, with decimal points or commas. What
// comes before the first row with a number in it may name the columns, and in a line below state their units;
// Yade's `#format` line, and a line of words behind a # where nothing else does, name them too.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "scene/foreign_table.h"
#include "scene/text_lines.h"

namespace mcdem {
namespace {

using Words = std::vector<std::string_view>;
constexpr std::size_t sampled_lines = 100;
constexpr std::size_t most_columns = 10'000;

/// Cells of a line; a cell in quotes may hold the separator.
void cut(std::string_view line, char separator, Words& cells) {
    if (separator == ' ') return split_at_blanks(line, cells);
    cells.clear();
    bool quoted_cell = false;
    std::size_t first = 0;
    const auto add = [&](std::size_t end) {
        std::string_view cell = without_blanks(line.substr(first, end - first));
        if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"')
            cell = cell.substr(1, cell.size() - 2);
        cells.push_back(cell);
        first = end + 1;
    };
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i] == '"') quoted_cell = !quoted_cell;
        if (line[i] == separator && !quoted_cell) add(i);
    }
    add(line.size());
}

bool is_number(std::string_view cell, char decimal) {
    if (decimal == '.' || cell.find(',') == cell.npos) return to_number(cell).has_value();
    if (cell.size() > 64 || cell.find('.') != cell.npos) return false;
    std::string point(cell);
    point[point.find(',')] = '.';
    return to_number(point).has_value();
}

long numbers_in(const Words& cells, char decimal) {
    return std::ranges::count_if(cells, [&](std::string_view cell) { return is_number(cell, decimal); });
}

/// 1.306 or 12.345,6 where the decimal is a comma, 1,306 where it is a point.
bool has_thousands(std::string_view cell, char decimal) {
    const char mark = decimal == ',' ? '.' : ',';
    if (cell.find(mark) == cell.npos) return false;
    if (cell.front() == '-' || cell.front() == '+') cell.remove_prefix(1);
    cell = cell.substr(0, cell.find(decimal));
    const auto digits = [](std::string_view text) {
        return std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
    };
    const auto first = cell.find(mark);
    if (first < 1 || first > 3 || cell.front() == '0' || !digits(cell.substr(0, first))) return false;
    for (cell.remove_prefix(first); !cell.empty(); cell.remove_prefix(4))
        if (cell.size() < 4 || cell.front() != mark || !digits(cell.substr(1, 3))) return false;
    return true;
}

/// What the cells tell of a table whose decimal is taken for a comma.
class DecimalComma {
public:
    void look_at(std::string_view cell, long line) {
        if (cell.find_first_of(",.") == cell.npos || !is_number(cell, ',')) return;
        Seen& seen = cell.find('.') != cell.npos ? point_ : has_thousands(cell, '.') ? either_ : comma_;
        if (seen.line == 0) seen = {cell, line};
    }
    /// No comma that can be nothing but a decimal.
    bool unclear() const { return either_.line > 0 && comma_.line == 0; }
    void report(FileProblems& problems) const {
        if (either_.line > 0 && point_.line > 0)
            problems.add(
                either_.line,
                fmt::format(
                    "numbers must have one decimal mark and no separators of thousands, got {} beside "
                    "{} in line {}: write the table with points only",
                    quoted(either_.cell), quoted(point_.cell), point_.line));
    }

private:
    struct Seen {
        std::string_view cell;
        long line = 0;
    };
    Seen point_, comma_, either_;  ///< the first of each kind
};

/// Lines that may hold data, from the first hundred.
std::vector<std::string_view> sample(std::string_view text) {
    std::vector<std::string_view> lines;
    TextLines all(text);
    for (auto line = all.next(); line && lines.size() < sampled_lines; line = all.next())
        if (const auto words = without_blanks(*line); !words.empty() && words.front() != '#')
            lines.push_back(*line);
    return lines;
}

/// The number of cells that most lines have; of several the largest.
std::size_t usual_width(const std::vector<std::string_view>& lines, char separator) {
    Words cells;
    std::map<std::size_t, long> counts;
    for (const std::string_view line : lines) {
        cut(line, separator, cells);
        ++counts[cells.size()];
    }
    return std::ranges::max_element(counts, {},
                                    [](const auto& count) { return std::pair(count.second, count.first); })
        ->first;
}

/// How well a form cuts the sample: the share of lines as wide as most, times that of numbers among their
/// cells.
double merit(const std::vector<std::string_view>& lines, TextForm form) {
    const std::size_t width = usual_width(lines, form.separator);
    Words cells;
    double alike = 0, numbers = 0;
    for (const std::string_view line : lines) {
        cut(line, form.separator, cells);
        if (cells.size() != width) continue;
        ++alike;
        numbers += static_cast<double>(numbers_in(cells, form.decimal)) / static_cast<double>(width);
    }
    const double of_lines = alike / static_cast<double>(lines.size());
    return (width > 1 ? 1 : 0.1) * of_lines * (0.01 + numbers / alike);
}

TextForm guess_form(std::string_view text) {
    const auto lines = sample(text);
    TextForm best{',', '.'};
    if (lines.empty()) return best;
    double most = -1;
    // In the order in which equally good ones are preferred.
    for (const TextForm form :
         {TextForm{';', '.'}, TextForm{';', ','}, TextForm{'\t', '.'}, TextForm{'\t', ','},
          TextForm{',', '.'}, TextForm{' ', '.'}, TextForm{' ', ','}}) {
        const double good = merit(lines, form);
        if (good <= most * (1 + 1e-9)) continue;
        most = good;
        best = form;
    }
    return best;
}

/// Yade's `#format x_y_z_r_matId`: what the columns are.
std::vector<std::string> yade_columns(std::string_view format) {
    std::vector<std::string> names;
    for (std::size_t first = 0; first < format.size();) {
        const auto end = std::min(format.find('_', first), format.size());
        names.emplace_back(format.substr(first, end - first));
        first = end + 1;
    }
    if (!names.empty() && names.back() == "attrs") names.pop_back();
    return names;
}

enum class CellKind { number, nothing, word };

CellKind kind_of(std::string_view cell) {
    if (is_number(cell, '.') || is_number(cell, ',')) return CellKind::number;
    for (const std::string_view nothing :
         {"", "-", "--", "nan", "NaN", "NAN", "na", "NA", "N/A", "n/a", "null", "NULL", "inf"})
        if (cell == nothing) return CellKind::nothing;
    return CellKind::word;
}

bool has(const Words& cells, CellKind kind) {
    return std::ranges::any_of(cells, [&](std::string_view cell) { return kind_of(cell) == kind; });
}

/// Lines above the last one of words only, which names the columns, where each of them has a word in a column
/// that holds only numbers below it: `Vorkraft;0,5;N` is no row of `Zeit;Weg;Kraft`.
std::size_t lines_above_names(const std::vector<std::string_view>& lines, char separator, std::size_t width) {
    Words cells;
    std::vector<bool> numeric(width, true);
    std::size_t names = lines.size();
    for (; names > 0; --names) {
        cut(lines[names - 1], separator, cells);
        if (has(cells, CellKind::word) && !has(cells, CellKind::number)) break;
        for (std::size_t c = 0; c < std::min(width, cells.size()); ++c)
            numeric[c] = numeric[c] && kind_of(cells[c]) != CellKind::word;
    }
    if (names == 0 || names == lines.size() || cells.size() < width) return 0;
    for (std::size_t line = 0; line + 1 < names; ++line) {
        cut(lines[line], separator, cells);
        bool unlike = cells.size() < width || !has(cells, CellKind::number);
        for (std::size_t c = 0; c < std::min(width, cells.size()); ++c)
            unlike = unlike || (numeric[c] && kind_of(cells[c]) == CellKind::word);
        if (!unlike) return 0;
    }
    return names - 1;
}

/// Lines before the first as wide as most, where they hold a word: `Probe;17` is no row.
std::size_t lines_above(std::string_view text, char separator) {
    const auto lines = sample(text);
    if (lines.empty()) return 0;
    const std::size_t width = usual_width(lines, separator);
    if (const std::size_t above = lines_above_names(lines, separator, width); above > 0) return above;
    Words cells;
    std::size_t above = 0;
    for (const std::string_view line : lines) {
        cut(line, separator, cells);
        if (cells.size() == width || !has(cells, CellKind::word)) return above;
        ++above;
    }
    return above;
}

class TextParser {
public:
    TextParser(ForeignTable& table, FileProblems& problems)
        : table_(table),
          problems_(problems),
          lines_(table.text),
          above_(lines_above(table.text, table.form.separator)) {}

    void parse() {
        while (!problems_.full()) {
            const auto line = lines_.next();
            if (!line) break;
            const std::string_view words = without_blanks(*line);
            if (words.empty()) continue;
            if (words.front() == '#')
                read_comment(words.substr(1));
            else
                read_line(*line);
        }
        if (table_.form.decimal == ',') comma_.report(problems_);
        table_.decimal_clear = table_.form.decimal != ',' || !comma_.unclear();
        if (table_.rows() == 0 && problems_.empty())
            problems_.add("must have at least one row with a number in it, got none");
    }

private:
    void read_comment(std::string_view words) {
        if (table_.rows() > 0) return;
        words = without_blanks(words);
        if (words.starts_with("format ")) {
            format_ = yade_columns(without_blanks(words.substr(7)));
            return;
        }
        cut(words, words.find(table_.form.separator) == words.npos ? ' ' : table_.form.separator, cells_);
        comment_.assign(cells_.begin(), cells_.end());
    }

    void read_line(std::string_view line) {
        cut(line, table_.form.separator, cells_);
        const bool has_numbers = numbers_in(cells_, table_.form.decimal) > 0;
        if (cells_.size() > 1 && cells_.back().empty() && has_numbers) {  // a separator at the line's end
            if (table_.rows() == 0) trailing_ = true;
            if (trailing_) cells_.pop_back();
        }
        const bool above = above_ > 0;
        if (above) --above_;
        if (table_.rows() == 0 && (above || !has_numbers)) {
            headings_.emplace_back(cells_.begin(), cells_.end());
        } else {
            if (table_.rows() == 0) name_columns();
            add_row();
        }
    }

    /// The last line of names before the first row counts, or the two last, where the second states units.
    void name_columns() {
        const std::size_t width = cells_.size();
        if (width > most_columns)
            problems_.add(lines_.number(),
                          fmt::format("must have at most {} columns, got {}", most_columns, width));
        std::erase_if(headings_,
                      [&](const auto& names) { return names.size() != width && names.size() != width + 1; });
        std::vector<std::string> names = format_;
        if (comment_.size() == width) names = comment_;
        if (!headings_.empty()) {
            names = headings_.back();
            if (headings_.size() > 1 && are_units(names)) {
                const auto units = names;
                names = headings_[headings_.size() - 2];
                for (std::size_t i = 0; i < std::min(names.size(), units.size()); ++i)
                    if (const auto unit = without_brackets(units[i]); !unit.empty())
                        names[i] += fmt::format(" [{}]", unit);
            }
        }
        table_.name_columns(names, width);
    }

    static bool are_units(const std::vector<std::string>& names) {
        return std::ranges::all_of(names, [](const std::string& name) {
            constexpr std::array<std::string_view, 19> units{"",  "-",  "m",  "cm", "mm", "um", "µm",
                                                             "N", "mN", "kN", "uN", "µN", "g",  "gf",
                                                             "s", "ms", "%",  "1",  "min"};
            return std::ranges::find(units, without_brackets(name)) != units.end();
        });
    }

    static std::string_view without_brackets(std::string_view word) {
        const bool has = word.size() >= 2 && (word.front() == '[' || word.front() == '(');
        return has ? word.substr(1, word.size() - 2) : word;
    }

    void add_row() {
        for (const std::string_view cell : cells_) {
            if (table_.form.decimal == ',') comma_.look_at(cell, lines_.number());
            if (has_thousands(cell, table_.form.decimal))
                return problems_.add(
                    lines_.number(),
                    fmt::format("numbers must have no separators of thousands, got {} where the decimal is "
                                "\"{}\": write the table without them",
                                quoted(cell), table_.form.decimal));
        }
        if (cells_.size() == table_.columns.size()) return table_.add_row(cells_);
        problems_.add(lines_.number(), fmt::format("must have {} columns as the first row, got {}",
                                                   table_.columns.size(), cells_.size()));
    }

    ForeignTable& table_;
    FileProblems& problems_;
    TextLines lines_;
    std::size_t above_;  ///< lines still to come that are none of the table's
    Words cells_;
    DecimalComma comma_;
    std::vector<std::string> format_, comment_;
    std::vector<std::vector<std::string>> headings_;
    bool trailing_ = false;  ///< rows end with a separator
};

}  // namespace

bool looks_like_yade(std::string_view text) {
    if (text.starts_with("#format ") || text.starts_with("# format ")) return true;
    const auto lines = sample(text.substr(0, 100'000));
    Words cells;
    if (lines.empty()) return false;
    split_at_blanks(lines.front(), cells);
    return cells.size() >= 4 && numbers_in(cells, '.') == static_cast<long>(cells.size());
}

void parse_text(ForeignTable& table, const std::optional<TextForm>& form, FileProblems& problems) {
    table.format = TableFormat::text;
    table.form = form ? *form : guess_form(table.text);
    TextParser(table, problems).parse();
}

}  // namespace mcdem
