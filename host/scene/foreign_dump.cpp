// Text dumps of LAMMPS and LIGGGHTS: `dump custom` (ITEM: ATOMS) and `dump local` (ITEM: ENTRIES), any number
// of frames, each of which names its columns.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "scene/foreign_table.h"
#include "scene/text_lines.h"

namespace mcdem {
namespace {

constexpr std::string_view item = "ITEM: ";

class DumpParser {
public:
    DumpParser(ForeignTable& table, FileProblems& problems)
        : table_(table), problems_(problems), lines_(table.text) {}

    void parse() {
        auto line = lines_.next();
        while (line && !problems_.full()) {
            const std::string_view title = without_blanks(*line);
            if (title.empty()) {
                line = lines_.next();
            } else if (!title.starts_with(item)) {
                problems_.add(
                    lines_.number(),
                    fmt::format("must be a line that begins with \"ITEM: \", got {}", quoted(title)));
                return;
            } else {
                line = section(title.substr(item.size()));
            }
        }
        if (table_.frames.empty() && problems_.empty())
            problems_.add("must hold at least one frame, got none");
    }

private:
    /// Reads what follows a title; gives the first line after it.
    std::optional<std::string_view> section(std::string_view title) {
        if (title.starts_with("ATOMS") || title.starts_with("ENTRIES")) return rows(title);
        if (title == "TIMESTEP") {
            step_ = whole_number("the timestep");
            count_.reset();
        } else if (title.starts_with("NUMBER OF ")) {
            count_ = whole_number("the number of rows");
        } else {  // bounds, units, time: not needed
            auto line = lines_.next();
            while (line && !line->starts_with(item)) line = lines_.next();
            return line;
        }
        return lines_.next();
    }

    std::optional<long> whole_number(const char* what) {
        const auto line = lines_.next();
        const auto number = line ? to_whole_number(without_blanks(*line)) : std::nullopt;
        if (!number || *number < 0)
            problems_.add(lines_.number(), fmt::format("{} must be a whole number >= 0, got {}", what,
                                                       line ? quoted(*line) : "the file's end"));
        return number;
    }

    void read_columns(std::string_view title) {
        split_at_blanks(title, words_);
        const std::vector<std::string> names(words_.begin() + 1, words_.end());
        if (names.empty())
            problems_.add(lines_.number(),
                          "the line must name the columns, got none: write the dump with a newer version");
        else if (table_.frames.empty())
            table_.name_columns(names_ = names, names.size());
        else if (names != names_)
            problems_.add(lines_.number(),
                          fmt::format("the columns must be those of the first frame, {}, got {}",
                                      fmt::join(names_, " "), fmt::join(names, " ")));
    }

    std::optional<std::string_view> rows(std::string_view title) {
        if (!step_) problems_.add(lines_.number(), "\"ITEM: TIMESTEP\" must come before, got none");
        read_columns(title);
        if (!problems_.empty()) return std::nullopt;
        const long title_line = lines_.number();
        table_.frames.push_back({*step_, table_.rows(), title_line});
        long found = 0;
        auto line = lines_.next();
        for (; line && !line->starts_with(item) && !problems_.full(); line = lines_.next()) {
            split_at_blanks(*line, words_);
            if (words_.empty()) continue;
            ++found;
            if (words_.size() == table_.columns.size())
                table_.add_row(words_);
            else
                problems_.add(lines_.number(), fmt::format("must have {} columns as line {} says, got {}",
                                                           table_.columns.size(), title_line, words_.size()));
        }
        if (count_ && found != *count_ && !problems_.full())
            problems_.add(title_line, fmt::format("must have the {} rows that the frame promises, got {}{}",
                                                  *count_, found, found < *count_ ? "; truncated?" : ""));
        step_.reset();
        return line;
    }

    ForeignTable& table_;
    FileProblems& problems_;
    TextLines lines_;
    std::vector<std::string_view> words_;
    std::vector<std::string> names_;  ///< of the columns, as the first frame has them
    std::optional<long> step_, count_;
};

}  // namespace

bool looks_like_dump(std::string_view text) {
    return without_blanks(text.substr(0, 1000)).substr(0, 200).find("ITEM: ") == 0;
}

void parse_dump(ForeignTable& table, FileProblems& problems) {
    table.format = TableFormat::dump;
    table.form = {' ', '.'};
    DumpParser(table, problems).parse();
}

}  // namespace mcdem
