#include <fmt/format.h>

#include <algorithm>

#include "scene/packing_fields.h"
#include "scene/read_packing.h"

namespace mcdem::inline scene {
namespace {

bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

/// Reads the file line by line; `words` and `hint` belong to the current line.
class LammpsReader {
public:
    LammpsReader(std::string_view text, const std::string& source) : lines_(text), problems_(source) {}

    Packing read() {
        next_line();  // the first line is always a title
        while (!in_atoms_ && !problems_.full() && next_line()) read_header_line();
        while (in_atoms_ && !problems_.full() && next_line()) read_atom_line();
        check_whole();
        problems_.report();
        return grains_.packing();
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
        if (!id || *id < 1)
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

    TextLines lines_;
    FileProblems problems_;
    std::vector<std::string_view> words_, hint_;
    bool in_atoms_ = false;
    std::optional<long> promised_;
    long promised_line_ = 0;
    GrainRows grains_{{.x = 4, .y = 5, .z = 6, .size = 2, .id = 0, .species = 1},
                      {"id", "type", "diameter", "density", "x", "y", "z"},
                      problems_};
};

}  // namespace

Packing read_lammps_packing(std::string_view text, const std::string& source) {
    return LammpsReader(text, source).read();
}

}  // namespace mcdem::scene
