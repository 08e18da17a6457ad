#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "scene/packing_fields.h"
#include "scene/read_packing.h"
#include "scene/text_lines.h"

namespace mcdem::inline scene {
namespace {

bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }

/// Reads the file line by line; `words` and `hint` belong to the current line.
class LammpsReader {
public:
    LammpsReader(std::istream& input, const std::string& source) : input_(input), problems_(source) {}

    Packing read() {
        next_line();  // the first line is always a title
        while (!in_atoms_ && !problems_.full() && next_line()) read_header_line();
        while (in_atoms_ && !problems_.full() && next_line()) read_atom_line();
        check_whole();
        problems_.report();
        return sorted_by_id();
    }

private:
    bool next_line() {
        if (!std::getline(input_, text_)) return false;
        ++line_;
        const std::size_t comment = std::min(text_.find('#'), text_.size());
        split_at_blanks(std::string_view(text_).substr(0, comment), words_);
        split_at_blanks(std::string_view(text_).substr(std::min(comment + 1, text_.size())), hint_);
        return true;
    }

    void read_header_line() {
        if (words_.size() == 2 && words_[1] == "atoms") {
            const auto count = to_whole_number(words_[0]);
            if (promised_) problems_.add(line_, "the number of atoms must be given once, got it again");
            if (!count || *count < 1 || *count > largest_packing)
                problems_.add(line_, fmt::format("the number of atoms must be between 1 and {}, got {}",
                                                 largest_packing, quoted(words_[0])));
            promised_ = count;
            promised_line_ = line_;
        } else if (!words_.empty() && words_[0] == "Atoms") {
            in_atoms_ = true;
            if (!hint_.empty() && hint_[0] != "sphere" && hint_[0] != "granular")
                problems_.add(line_, fmt::format("the atom style must be sphere or granular, got {}",
                                                 quoted(hint_[0])));
        }
    }

    void read_atom_line() {
        if (words_.empty()) return;
        if (is_letter(words_[0].front()) && !to_number(words_[0]) && words_.size() < 7) {
            in_atoms_ = false;  // the next section
            return;
        }
        if (words_.size() != 7 && words_.size() != 10) {
            problems_.add(line_,
                          fmt::format("an atom must have 7 columns (id type diameter density x y z) or 10 "
                                      "(3 image flags more), got {}",
                                      words_.size()));
            return;
        }
        const auto id = to_whole_number(words_[0]);
        if (!id || *id < 1)
            problems_.add(line_,
                          fmt::format("the atom's id must be a whole number > 0, got {}", quoted(words_[0])));
        if (static_cast<long>(ids_.size()) >= largest_packing) return;
        add_grain(packing_, words_[4], words_[5], words_[6], words_[2], line_, problems_);
        add_species(packing_, words_[1]);
        ids_.push_back(id.value_or(0));
        lines_.push_back(line_);
    }

    void check_whole() {
        if (problems_.full()) return;
        if (lines_.empty() && problems_.empty())
            problems_.add("must have a section Atoms with at least 1 line, got none");
        if (!promised_ && promised_line_ == 0)
            problems_.add(
                "must say the number of atoms before the section Atoms (\"514 atoms\"), got no such line");
        else if (promised_ && problems_.empty() && *promised_ != static_cast<long>(ids_.size()))
            problems_.add(fmt::format("must have the {} atoms that line {} promises, got {}{}", *promised_,
                                      promised_line_, ids_.size(),
                                      *promised_ > static_cast<long>(ids_.size()) ? "; truncated?" : ""));
    }

    Packing sorted_by_id() {
        std::vector<std::size_t> order(ids_.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return ids_[a] < ids_[b]; });
        Packing sorted;
        for (std::size_t k = 0; k < order.size(); ++k) {
            const std::size_t i = order[k];
            if (k > 0 && ids_[i] == ids_[order[k - 1]])
                problems_.add(lines_[i],
                              fmt::format("each atom must have its own id, got {} again (first in line {})",
                                          ids_[i], lines_[order[k - 1]]));
            sorted.position.push_back(packing_.position[i]);
            sorted.diameter.push_back(packing_.diameter[i]);
            sorted.species.push_back(packing_.species[i]);
        }
        problems_.report();
        sorted.species_names = packing_.species_names;
        return sorted;
    }

    std::istream& input_;
    FileProblems problems_;
    std::string text_;
    long line_ = 0;
    std::vector<std::string_view> words_, hint_;
    bool in_atoms_ = false;
    std::optional<long> promised_;
    long promised_line_ = 0;
    Packing packing_;
    std::vector<long> ids_, lines_;
};

}  // namespace

Packing read_lammps_packing(std::istream& input, const std::string& source) {
    return LammpsReader(input, source).read();
}

}  // namespace mcdem::scene
