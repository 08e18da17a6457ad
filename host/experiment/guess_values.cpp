// What columns without telling names are, from their numbers.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "experiment/findings.h"
#include "experiment/guess.h"

namespace mcdem {
namespace {

constexpr std::size_t most_rows = 20'000;  // that are looked at

std::vector<double> numbers_of(const ForeignTable& part, std::size_t column) {
    std::vector<double> numbers(std::min(part.rows(), most_rows));
    for (std::size_t row = 0; row < numbers.size(); ++row)
        numbers[row] = part.number(row, column).value_or(std::nan(""));
    return numbers;
}

/// Most of it, for a table may have gaps; text is none.
bool has_numbers(const std::vector<double>& numbers) {
    return 2 * std::ranges::count_if(numbers, [](double x) { return std::isfinite(x); }) >
           std::ssize(numbers);
}

bool all_whole(const std::vector<double>& numbers) {
    return std::ranges::all_of(numbers, [](double x) { return x == std::round(x) && std::abs(x) < 2e9; });
}

/// Rows of the first frame: as long as the columns before `x` that are whole and constant at first do not
/// change.
std::size_t first_frame(const ForeignTable& part, const std::vector<std::vector<double>>& columns) {
    std::size_t rows = columns.front().size();
    if (part.frames.size() > 1) rows = std::min(rows, part.frames[1].first_row);
    for (const auto& column : columns) {
        if (column.size() < 2 || column[0] != column[1] || !all_whole(column)) continue;
        const auto change = std::ranges::find_if(column, [&](double x) { return x != column[0]; });
        rows = std::min(rows, static_cast<std::size_t>(change - column.begin()));
    }
    return rows;
}

void name_leading_columns(MappedTable& map, const ForeignTable& part,
                          const std::vector<std::vector<double>>& columns, std::size_t count,
                          std::size_t frame_rows) {
    for (std::size_t c = 0; c < count; ++c) {
        const auto& column = columns[c];
        const std::set<double> first(column.begin(), column.begin() + static_cast<long>(frame_rows));
        if (!all_whole(column)) continue;
        if (first.size() == 1 && frame_rows < column.size() && !map.has("frame") && part.frames.empty())
            map.entries["frame"] =
                guess(part.columns[c], Sure::likely, "whole numbers, the same over many rows");
        else if (first.size() == frame_rows && !map.has("grain"))
            map.entries["grain"] =
                guess(part.columns[c], Sure::likely, "whole numbers, each once in a frame");
    }
}

/// Rows of contacts between grains of known places: which columns are forces.
struct Pair {
    std::size_t row;
    Vec3 away;  ///< unit vector from the partner to the grain, as the grains' table counts
};

/// How well three columns are forces along the lines of centres: the median of |cos| of the angle between
/// them.
double alignment(const std::vector<std::vector<double>>& columns, std::size_t first,
                 const std::vector<Pair>& pairs) {
    std::vector<double> cosines;
    for (const Pair& pair : pairs) {
        const Vec3 force(columns[first][pair.row], columns[first + 1][pair.row],
                         columns[first + 2][pair.row]);
        if (!(force.norm() > 0)) continue;
        cosines.push_back(std::abs(force.normalized().dot(pair.away)));
    }
    return cosines.size() < 3 ? 0 : median(std::move(cosines));
}

/// The pairs that two columns name, where nearly all of them touch.
std::vector<Pair> touching_pairs(const ForeignTable& part, const std::vector<double>& first,
                                 const std::vector<double>& second, const GrainFrames& grains) {
    std::vector<Pair> pairs;
    std::size_t frame = 0, known = 0;
    for (std::size_t row = 0; row < first.size(); ++row) {
        while (frame + 1 < part.frames.size() && part.frames[frame + 1].first_row <= row) ++frame;
        const int at =
            part.frames.empty() ? 0 : grains.index.find(static_cast<double>(part.frames[frame].step));
        const auto a = grains.number_of.find(static_cast<long>(first[row])),
                   b = grains.number_of.find(static_cast<long>(second[row]));
        if (at < 0 || a == grains.number_of.end() || b == grains.number_of.end() || a == b) continue;
        ++known;
        const auto i = static_cast<std::size_t>(a->second), j = static_cast<std::size_t>(b->second);
        const auto& position = grains.position[static_cast<std::size_t>(at)];
        const Vec3 line = position[i] - position[j];
        if (line.norm() < 0.6 * (grains.diameter[i] + grains.diameter[j]))
            pairs.push_back({row, line.normalized().cwiseProduct(grains.sign)});
    }
    if (known < first.size() / 2 || pairs.size() < 0.9 * static_cast<double>(known)) pairs.clear();
    return pairs;
}

}  // namespace

double nearest_over_radii(const std::vector<Vec3>& position, const std::vector<double>& diameter) {
    constexpr std::size_t most = 2000;
    const std::size_t count = std::min(position.size(), most);
    std::vector<double> nearest;
    for (std::size_t i = 0; i < std::min<std::size_t>(count, 200); ++i) {
        double least = INFINITY;
        for (std::size_t j = 0; j < count; ++j)
            if (i != j)
                least = std::min(least, 2 * (position[i] - position[j]).norm() / (diameter[i] + diameter[j]));
        nearest.push_back(least);
    }
    return count < 3 ? std::nan("") : median(std::move(nearest));
}

void guess_grains_by_values(ImportTable& table) {
    const ForeignTable& part = *table.parts.front();
    std::vector<std::vector<double>> columns;
    for (std::size_t c = 0; c < std::min<std::size_t>(part.columns.size(), 50); ++c)
        columns.push_back(numbers_of(part, c));
    const std::size_t rows = first_frame(part, columns);
    for (std::size_t c = 0; c + 3 < columns.size(); ++c) {
        std::vector<Vec3> position;
        std::vector<double> size;
        bool whole = true, sound = true;
        for (std::size_t row = 0; row < rows; ++row) {
            position.emplace_back(columns[c][row], columns[c + 1][row], columns[c + 2][row]);
            size.push_back(columns[c + 3][row]);
            sound = sound && position.back().allFinite() && size.back() > 0;
            whole = whole && size.back() == std::round(size.back()) &&
                    position.back().x() == std::round(position.back().x());
        }
        if (!sound || whole) continue;
        const double ratio = nearest_over_radii(position, size);
        const bool diameters = ratio > 0.75 && ratio<1.25, radii = ratio> 1.5 && ratio < 2.5;
        if (!diameters && !radii) continue;
        MappedTable& map = table.map;
        map.role = Role::grains;
        map.role_sure = Sure::likely;
        map.role_why = fmt::format("columns {} to {} taken for spheres touch one another", c + 1, c + 4);
        for (std::size_t k = 0; k < 3; ++k)
            map.entries[std::string(1, "xyz"[k])] =
                guess(part.columns[c + k], Sure::likely, "the usual order");
        map.entries[radii ? "radius" : "diameter"] =
            guess(part.columns[c + 3], Sure::likely, "spheres of that size touch one another");
        name_leading_columns(map, part, columns, c, rows);
        return;
    }
}

void guess_contacts_by_values(ImportTable& table, const GrainFrames& grains) {
    const ForeignTable& part = *table.parts.front();
    if (grains.keys.empty()) return;
    std::vector<std::vector<double>> columns;
    for (std::size_t c = 0; c < std::min<std::size_t>(part.columns.size(), 50); ++c)
        columns.push_back(numbers_of(part, c));
    for (std::size_t a = 0; a + 1 < columns.size(); ++a) {
        const std::size_t b = a + 1;
        if (!all_whole(columns[a]) || !all_whole(columns[b])) continue;
        const auto pairs = touching_pairs(part, columns[a], columns[b], grains);
        if (pairs.empty()) continue;
        double most = 0;
        std::size_t best = 0, good = 0;
        for (std::size_t c = 0; c + 2 < columns.size(); ++c) {
            if ((c <= b && c + 2 >= a)) continue;
            const double fit = alignment(columns, c, pairs);
            good += fit > 0.9 ? 1 : 0;
            if (fit > most) most = fit, best = c;
        }
        std::size_t others = 0;  // columns that may hold more of the forces
        for (std::size_t c = 0; c < columns.size(); ++c)
            others += (c < best || c > best + 2) && has_numbers(columns[c]) && !all_whole(columns[c]) ? 1 : 0;
        const bool only = most > 0.9 && good == 1 && others < 3;
        const std::string seen = good > 1 ? fmt::format("one of {} triples of columns that point", good)
                                 : others >= 3
                                     ? "other columns may hold a tangential part to be added; points"
                                     : "points";
        MappedTable& map = table.map;
        map.role = Role::contacts;
        map.role_sure = Sure::likely;
        map.role_why = "two columns name grains that touch";
        map.entries["grain"] =
            guess(part.columns[a], Sure::likely, "names grains that touch those of the next column");
        map.entries["partner"] =
            guess(part.columns[b], Sure::likely, "names grains that touch those of the column before");
        for (std::size_t k = 0; most > 0 && k < 3; ++k)
            map.entries[fmt::format("f{}", "xyz"[k])] =
                guess(part.columns[best + k], only ? Sure::likely : Sure::unclear,
                      fmt::format("{} along the lines of centres (median cosine {:.3f})", seen, most));
        return;
    }
}

void guess_plate_by_values(ImportTable& table) {
    const ForeignTable& part = *table.parts.front();
    MappedTable& map = table.map;
    std::vector<std::size_t> numeric;
    for (std::size_t c = 0; c < std::min<std::size_t>(part.columns.size(), 9); ++c)
        if (has_numbers(numbers_of(part, c))) numeric.push_back(c);
    if (numeric.size() < 2 || part.columns.size() > 8) return;
    const auto first = numbers_of(part, numeric[0]);
    const bool counts =
        numeric.size() > 2 && std::ranges::adjacent_find(first, std::greater_equal<>()) == first.end();
    map.role = Role::plate;
    map.role_sure = Sure::unclear;
    map.role_why = "no names, no grains";
    const std::size_t next = counts ? 1 : 0;
    if (counts)
        map.entries["frame"] = guess(part.columns[numeric[0]], Sure::unclear, "rises from row to row");
    map.entries["plate_z"] = guess(part.columns[numeric[next]], Sure::unclear, "by its place only");
    map.entries["top_force"] = guess(part.columns[numeric[next + 1]], Sure::unclear, "by its place only");
}

}  // namespace mcdem
