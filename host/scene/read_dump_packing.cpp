// Text dumps of LAMMPS and LIGGGHTS (`dump custom`): any number of frames, each with the names of its
// columns.
#include <fmt/format.h>

#include "core/errors.h"
#include "scene/packing_fields.h"
#include "scene/read_packing.h"

namespace mcdem::inline scene {
namespace {

constexpr std::string_view item = "ITEM: ";

class DumpReader {
public:
    DumpReader(std::string_view text, const std::string& source, std::optional<long> wanted)
        : source_(source), problems_(source), lines_(text), wanted_(wanted) {}

    Packing read() {
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
        return grains_->packing();
    }

private:
    /// Reads the section under a title; returns its first line.
    std::optional<std::string_view> section(std::string_view title) {
        if (title.starts_with("ATOMS")) return rows(title);
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

    std::optional<std::string_view> rows(std::string_view title) {
        if (!step_) problems_.add(lines_.number(), "\"ITEM: TIMESTEP\" must come before, got none");
        if (!problems_.empty()) return std::nullopt;
        split_at_blanks(title, words_);
        const std::vector<std::string> names(words_.begin() + 1, words_.end());
        const bool is_wanted = !wanted_ || *wanted_ == *step_;
        if (is_wanted) grains_.emplace(GrainColumns::named(names, source_), names, problems_);
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
};

}  // namespace

bool looks_like_dump(std::string_view text) { return without_blanks(text.substr(0, 1000)).starts_with(item); }

Packing read_dump_packing(std::string_view text, const std::string& source, std::optional<long> step) {
    return DumpReader(text, source, step).read();
}

}  // namespace mcdem::scene
