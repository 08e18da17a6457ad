// Shared code of the packing readers: lines, words and numbers, and grains from the rows of a table.
#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/packing/file_packing.h"
#include "scene/read/problems.h"

namespace mcdem::inline scene {

/// The whole word as a number; nothing if characters remain or it is not finite.
std::optional<double> to_number(std::string_view word);
std::optional<long> to_whole_number(std::string_view word);

/// A word for use in messages: short, without control characters.
std::string quoted(std::string_view word);

/// Appends the name of the grain's species in the file.
void add_species(Packing& packing, std::string_view word);

/// Column numbers of a grain's values.
struct GrainColumns {
    std::size_t x, y, z, size;
    double diameters = 1;  ///< diameters per `size`: 2 for a radius
    std::optional<std::size_t> id = {}, species = {};
    std::optional<std::size_t> radius = {};               ///< beside a diameter: must agree with it
    std::optional<std::size_t> density = {}, mass = {};   ///< [kg/m3], [kg]; a mass counts without a density
    std::optional<std::size_t> velocity = {}, spin = {};  ///< the first of three, along x, y and z

    /// For columns x, y, z (or xu, yu, zu) and diameter, radius or r, optionally id, species or type, density
    /// and mass.
    /// Throws InputError.
    static GrainColumns named(const std::vector<std::string>& names, const std::string& file);
};

/// The grains of one frame, ordered by id if there are ids, otherwise by row.
class GrainRows {
public:
    GrainRows(GrainColumns columns, std::vector<std::string> names, FileProblems& problems)
        : columns_(columns), names_(std::move(names)), problems_(problems) {}
    void add(const std::vector<std::string_view>& words, long line);
    std::size_t size() const { return packing_.size(); }
    /// Throws InputError if there were any problems.
    FilePacking packing() const;

private:
    Vec3 vector(const std::vector<std::string_view>& words, std::size_t first, const char* unit, long line);
    void add_density(const std::vector<std::string_view>& words, long line);
    GrainColumns columns_;
    std::vector<std::string> names_;
    FileProblems& problems_;
    FilePacking packing_;
    std::vector<double> ids_;
    std::vector<long> lines_;
};

/// Iterates over the lines of a text.
class TextLines {
public:
    explicit TextLines(std::string_view text) : rest_(text) {}
    /// The next line without its line end (Unix or Windows); nothing after the last one.
    std::optional<std::string_view> next() {
        if (rest_.empty()) return std::nullopt;
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        ++number_;
        return line;
    }
    long number() const { return number_; }

private:
    std::string_view rest_;
    long number_ = 0;
};

inline std::string_view without_blanks(std::string_view text) {
    constexpr std::string_view blank = " \t\r";
    const auto first = text.find_first_not_of(blank);
    if (first == text.npos) return text.substr(0, 0);
    return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

/// Splits a line at blanks.
inline void split_at_blanks(std::string_view line, std::vector<std::string_view>& words) {
    constexpr std::string_view blank = " \t\r";
    words.clear();
    for (std::size_t begin = line.find_first_not_of(blank); begin != line.npos;) {
        const std::size_t end = std::min(line.find_first_of(blank, begin), line.size());
        words.push_back(line.substr(begin, end - begin));
        begin = line.find_first_not_of(blank, end);
    }
}

}  // namespace mcdem::scene
