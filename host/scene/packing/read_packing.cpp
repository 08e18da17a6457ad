#include "scene/packing/read_packing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "core/errors.h"
#include "core/input_file.h"
#include "core/look.h"
#include "scene/packing/packing_fields.h"
#include "scene/packing/stated_box.h"
#include "scene/packing/table.h"

namespace mcdem::inline scene {
namespace {

constexpr std::string_view item = "ITEM: ";

/// Text dumps of LAMMPS and LIGGGHTS (`dump custom`): any number of frames, each with the names of its
/// columns.
class DumpReader {
public:
    DumpReader(std::string_view text, const std::string& source, std::optional<long> wanted)
        : source_(source), problems_(source), lines_(text), wanted_(wanted) {}

    FilePacking read() {
        auto line = lines_.next();
        while (line && !problems_.full()) {
            const std::string_view title = without_blanks(*line);
            if (!title.empty() && !title.starts_with(item)) {
                problems_.add(
                    lines_.number(),
                    fmt::format("must be a line that begins with \"ITEM: \", got {}", quoted(title)));
                break;
            }
            line = title.empty() ? lines_.next() : section(title.substr(item.size()));
        }
        if (steps_.empty() && problems_.empty()) problems_.add("must hold at least one frame, got none");
        problems_.report();
        if (!grains_)
            throw InputError(fmt::format("{}: the frame must be one of its {} timesteps, {} to {}, got {}",
                                         source_, steps_.size(), steps_.front(), steps_.back(), *wanted_));
        FilePacking packing = grains_->packing();
        packing.box = of_grains_;
        return packing;
    }

private:
    /// Reads the section under a title; returns its first line.
    std::optional<std::string_view> section(std::string_view title) {
        if (title.starts_with("ATOMS")) return rows(title);
        if (title == "TIMESTEP") {
            step_ = whole_number("the timestep");
            count_.reset();
            box_.reset();
        } else if (title.starts_with("NUMBER OF ")) {
            count_ = whole_number("the number of rows");
        } else {  // bounds; units and time are not needed
            const long first = lines_.number() + 1;
            std::vector<std::string_view> rows;
            auto line = lines_.next();
            for (; line && !line->starts_with(item); line = lines_.next())
                if (rows.size() < 3) rows.push_back(*line);
            if (title.starts_with("BOX BOUNDS")) box_ = dump_box(title, rows, first, source_, problems_);
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

    std::optional<std::string_view> rows(std::string_view title) {
        if (!step_) problems_.add(lines_.number(), "\"ITEM: TIMESTEP\" must come before, got none");
        if (!problems_.empty()) return std::nullopt;
        split_at_blanks(title, words_);
        const std::vector<std::string> names(words_.begin() + 1, words_.end());
        const bool is_wanted = !wanted_ || *wanted_ == *step_;
        if (is_wanted) grains_.emplace(GrainColumns::named(names, source_), names, problems_);
        if (is_wanted) of_grains_ = box_;
        steps_.push_back(*step_);
        const long title_line = lines_.number();
        long found = 0;
        auto line = lines_.next();
        for (; line && !line->starts_with(item) && !problems_.full(); line = lines_.next()) {
            split_at_blanks(*line, words_);
            if (words_.empty()) continue;
            ++found;
            if (words_.size() != names.size())
                problems_.add(lines_.number(), fmt::format("must have {} columns as line {} says, got {}",
                                                           names.size(), title_line, words_.size()));
            else if (is_wanted)
                grains_->add(words_, lines_.number());
        }
        if (count_ && found != *count_ && !problems_.full())
            problems_.add(title_line, fmt::format("must have the {} rows that the frame promises, got {}{}",
                                                  *count_, found, found < *count_ ? "; truncated?" : ""));
        step_.reset();
        return line;
    }

    const std::string& source_;
    FileProblems problems_;
    TextLines lines_;
    std::optional<long> wanted_, step_, count_;
    std::vector<std::string_view> words_;
    std::vector<long> steps_;
    std::optional<GrainRows> grains_;  ///< of the requested frame, or the last one so far
    std::optional<StatedBox> box_, of_grains_;
};

bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

/// LAMMPS data files, line by line; `words` and `hint` belong to the current line.
class LammpsReader {
public:
    LammpsReader(std::string_view text, const std::string& source)
        : source_(source), lines_(text), problems_(source) {}

    FilePacking read() {
        next_line();  // the first line is always a title
        while (!in_atoms_ && !problems_.full() && next_line()) read_header_line();
        while (in_atoms_ && !problems_.full() && next_line()) read_atom_line();
        check_whole();
        const auto box = box_.box(source_, problems_);
        problems_.report();
        FilePacking packing = grains_.packing();
        packing.box = box;
        return packing;
    }

private:
    bool next_line() {
        const auto line = lines_.next();
        if (!line) return false;
        const std::size_t comment = std::min(line->find('#'), line->size());
        split_at_blanks(line->substr(0, comment), words_);
        split_at_blanks(line->substr(std::min(comment + 1, line->size())), hint_);
        return true;
    }

    void read_header_line() {
        if (box_.read(words_, lines_.number(), problems_)) return;
        if (words_.size() == 2 && words_[1] == "atoms") {
            const auto count = to_whole_number(words_[0]);
            if (promised_)
                problems_.add(lines_.number(), "the number of atoms must be given once, got it again");
            if (!count || *count < 1 || *count > largest_packing)
                problems_.add(lines_.number(),
                              fmt::format("the number of atoms must be between 1 and {}, got {}",
                                          largest_packing, quoted(words_[0])));
            promised_ = count;
            promised_line_ = lines_.number();
        } else if (!words_.empty() && words_[0] == "Atoms") {
            in_atoms_ = true;
            if (!hint_.empty() && hint_[0] != "sphere" && hint_[0] != "granular")
                problems_.add(
                    lines_.number(),
                    fmt::format("the atom style must be sphere or granular, got {}", quoted(hint_[0])));
        }
    }

    void read_atom_line() {
        if (words_.empty()) return;
        if (is_letter(words_[0].front()) && !to_number(words_[0]) && words_.size() < 7) {
            in_atoms_ = false;  // the next section
            return;
        }
        if (words_.size() != 7 && words_.size() != 10) {
            problems_.add(lines_.number(),
                          fmt::format("an atom must have 7 columns (id type diameter density x y z) or 10 "
                                      "(3 image flags more), got {}",
                                      words_.size()));
            return;
        }
        const auto id = to_whole_number(words_[0]);
        if (to_number(words_[0]) && (!id || *id < 1))
            problems_.add(lines_.number(),
                          fmt::format("the atom's id must be a whole number > 0, got {}", quoted(words_[0])));
        grains_.add(words_, lines_.number());
    }

    void check_whole() {
        if (problems_.full()) return;
        if (grains_.size() == 0 && problems_.empty())
            problems_.add("must have a section Atoms with at least 1 line, got none");
        if (!promised_ && promised_line_ == 0)
            problems_.add(
                "must say the number of atoms before the section Atoms (\"514 atoms\"), got no such line");
        else if (promised_ && problems_.empty() && *promised_ != static_cast<long>(grains_.size()))
            problems_.add(fmt::format("must have the {} atoms that line {} promises, got {}{}", *promised_,
                                      promised_line_, grains_.size(),
                                      *promised_ > static_cast<long>(grains_.size()) ? "; truncated?" : ""));
    }

    const std::string& source_;
    TextLines lines_;
    FileProblems problems_;
    DataBox box_;
    std::vector<std::string_view> words_, hint_;
    bool in_atoms_ = false;
    std::optional<long> promised_;
    long promised_line_ = 0;
    GrainRows grains_{{.x = 4, .y = 5, .z = 6, .size = 2, .id = 0, .species = 1, .density = 3},
                      {"id", "type", "diameter", "density", "x", "y", "z"},
                      problems_};
};

// Yade's text files from export.text and export.textExt: x y z r, or the columns in the `#format` line.
constexpr std::string_view mark = "format ";

/// The words after a # at the beginning of a line.
std::string_view comment_of(std::string_view line) {
    line = without_blanks(line);
    return line.starts_with('#') ? without_blanks(line.substr(1)) : std::string_view();
}

bool is_row(std::string_view line) {
    line = without_blanks(line);
    return !line.empty() && line.front() != '#';
}

/// Columns in a line `#format x_y_z_r_matId`, or in another comment if it names x, y and z; otherwise none.
std::vector<std::string> columns_of(std::string_view comment) {
    std::vector<std::string> names;
    if (!comment.starts_with(mark)) {
        std::vector<std::string_view> words;
        split_at_blanks(comment, words);
        const auto has = [&](std::string_view word) { return std::ranges::find(words, word) != words.end(); };
        if (has("x") && has("y") && has("z")) names.assign(words.begin(), words.end());
        return names;
    }
    const std::string_view format = without_blanks(comment.substr(mark.size()));
    for (std::size_t first = 0; first < format.size();) {
        const auto end = std::min(format.find('_', first), format.size());
        names.emplace_back(format.substr(first, end - first));
        first = end + 1;
    }
    return names;
}

/// Whether a CSV table has the three columns of a vector; some of them alone are a problem.
bool has_vector(const Table& table, const std::array<std::size_t, 3>& columns, std::string_view names,
                FileProblems& problems) {
    const auto there = std::ranges::count_if(columns, [&](std::size_t c) { return table.has(c); });
    if (there == 1 || there == 2)
        problems.add(
            fmt::format("the header must name {} together or not at all, got {} of them", names, there));
    return there == 3;
}

}  // namespace

bool looks_like_dump(std::string_view text) { return without_blanks(text.substr(0, 1000)).starts_with(item); }

FilePacking read_dump_packing(std::string_view text, const std::string& source, std::optional<long> step) {
    return DumpReader(text, source, step).read();
}

FilePacking read_lammps_packing(std::string_view text, const std::string& source) {
    return LammpsReader(text, source).read();
}

bool looks_like_yade(std::string_view text) {
    if (comment_of(text.substr(0, text.find('\n'))).starts_with(mark)) return true;
    TextLines lines(text);
    auto line = lines.next();
    while (line && !is_row(*line)) line = lines.next();
    std::vector<std::string_view> words;
    if (line) split_at_blanks(*line, words);
    return words.size() >= 4 &&
           std::ranges::all_of(words, [](auto word) { return to_number(word).has_value(); });
}

FilePacking read_yade_packing(std::string_view text, const std::string& source) {
    FileProblems problems(source);
    const std::vector<std::string> plain{"x", "y", "z", "r"};
    std::vector<std::string> names;
    std::optional<GrainRows> grains;
    std::vector<std::string_view> words;
    TextLines lines(text);
    std::size_t width = 0;
    for (auto line = lines.next(); line && !problems.full(); line = lines.next()) {
        if (const auto named = columns_of(comment_of(*line)); !grains && !named.empty()) names = named;
        if (!is_row(*line)) continue;
        split_at_blanks(*line, words);
        if (!grains) {
            width = words.size();
            if (names.empty() && width > plain.size())
                problems.add(
                    lines.number(),
                    fmt::format("must have 4 columns, x y z r, where no line names them, got {}: write "
                                "a line such as \"#format x_y_z_r_matId\" before",
                                width));
            if (names.empty()) names = plain;
            grains.emplace(GrainColumns::named(names, source), names, problems);
        }
        if (words.size() == width && width >= names.size() - (names.back() == "attrs" ? 1 : 0))
            grains->add(words, lines.number());
        else
            problems.add(lines.number(),
                         fmt::format("must have {} columns, as the first row or the #format line, got {}",
                                     std::max(width, names.size()), words.size()));
    }
    if (!grains) problems.add("must have at least one row with a number in it, got none");
    problems.report();
    return grains->packing();
}

FilePacking read_csv_packing(const std::string& text, const std::string& source, std::optional<long> wanted) {
    FileProblems problems(source);
    Table table(source, text, {"x_m", "y_m", "z_m", "diameter_m"}, problems,
                {"frame", "species", "type", "vx_m_s", "vy_m_s", "vz_m_s", "spin_x_1_s", "spin_y_1_s",
                 "spin_z_1_s", "radius_m", "density_kg_m3"});
    const bool has_frames = table.has(4), has_species = table.has(5) || table.has(6);
    const std::size_t species_column = table.has(5) ? 5 : 6;
    if (wanted && !has_frames && problems.empty())
        problems.add("must have a column frame where packing.frame is given, got none");
    GrainColumns columns{.x = 0, .y = 1, .z = 2, .size = 3};
    if (has_species) columns.species = 4;
    if (table.has(13)) columns.radius = 11;
    if (table.has(14)) columns.density = 12;
    if (has_vector(table, {7, 8, 9}, "vx_m_s, vy_m_s and vz_m_s", problems)) columns.velocity = 5;
    if (has_vector(table, {10, 11, 12}, "spin_x_1_s, spin_y_1_s and spin_z_1_s", problems)) columns.spin = 8;
    GrainRows grains(columns,
                     {"x", "y", "z", "diameter", "species", "vx_m_s", "vy_m_s", "vz_m_s", "spin_x_1_s",
                      "spin_y_1_s", "spin_z_1_s", "radius", "density"},
                     problems);
    std::set<long> frames;
    while (!problems.full() && table.next()) {
        const auto frame = has_frames ? table.whole_number(4, 0) : wanted;
        if (has_frames && frame) frames.insert(*frame);
        if (!wanted) wanted = frame;  // the first
        if (frame != wanted) continue;
        const std::string_view species = table.text(species_column);
        std::vector<std::string_view> words{table.text(0), table.text(1), table.text(2), table.text(3),
                                            species};
        for (std::size_t column = 7; column < 15; ++column) words.push_back(table.text(column));
        grains.add(words, table.line());
        if (has_species && species.empty()) table.problem("the species must be a name or a number, got none");
    }
    if (grains.size() == 0 && problems.empty() && !frames.empty())
        problems.add(fmt::format("the frame must be one of its {} frames, {} to {}, got {}", frames.size(),
                                 *frames.begin(), *frames.rbegin(), *wanted));
    FilePacking packing = grains.packing();
    packing.unread = table.others();
    std::erase(packing.unread, "grain");  // of an experiment's grains.csv
    return packing;
}

FilePacking read_packing(const std::filesystem::path& file, std::optional<long> frame) {
    if (!is_there(file))
        throw InputError(fmt::format("{}: must be a packing, got no such file", file.string()));
    if (!is_file(file))
        throw InputError(
            fmt::format("{}: must be a packing, got something that is not a file", file.string()));
    constexpr std::uintmax_t largest_file = std::uintmax_t{2} << 30;
    if (size_of_file(file) > largest_file)
        throw InputError(fmt::format("{}: must be a packing of at most 2 GiB, got more", file.string()));
    const std::string text = read_file(file), source = file.string();
    const std::string_view beginning = std::string_view(text).substr(0, 1 << 16);
    if (beginning.starts_with("\x89HDF\r\n"))
        throw InputError(source + ": run.h5 cannot be read as a packing here");
    if (beginning.starts_with("\x1f\x8b"))
        throw InputError(fmt::format("{}: must not be packed, got a file of gzip: unpack it", source));
    if (file.extension() == ".csv") return read_csv_packing(text, source, frame);
    if (looks_like_dump(beginning)) return read_dump_packing(text, source, frame);
    if (frame)
        throw InputError(
            fmt::format("{}: must be a dump, grains.csv or run.h5 where packing.frame is given, got a file "
                        "with one packing",
                        source));
    if (looks_like_yade(beginning)) return read_yade_packing(text, source);
    return read_lammps_packing(text, source);
}

}  // namespace mcdem::scene
