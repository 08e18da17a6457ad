#include "diagnose/decide/location.h"

#include <algorithm>
#include <cmath>

namespace mcdem::inline diagnose {
namespace {

/// Merges neighbouring significant displacements of one observable and phase into entries.
void gather_ranges(const std::vector<WhereCell>& row, double threshold, double half_spacing,
                   const Observable& observable, std::vector<WhereEntry>& entries) {
    for (std::size_t first = 0; first < row.size(); ++first) {
        if (std::abs(row[first].z_score_refitted) < threshold) continue;
        std::size_t last = first;
        while (last + 1 < row.size() && std::abs(row[last + 1].z_score_refitted) >= threshold) ++last;
        const auto strongest = std::max_element(
            row.begin() + static_cast<std::ptrdiff_t>(first),
            row.begin() + static_cast<std::ptrdiff_t>(last) + 1,
            [](auto& a, auto& b) { return std::abs(a.z_score_refitted) < std::abs(b.z_score_refitted); });
        WhereEntry entry;
        entry.observable = observable.name;
        entry.phase = row[first].phase;
        entry.displacement = {row[first].displacement - half_spacing, row[last].displacement + half_spacing};
        if (!observable.region.empty()) entry.region = observable.region;
        if (!observable.force_class.empty()) entry.force_class = observable.force_class;
        entry.z_score = strongest->z_score;
        entry.z_score_refitted = strongest->z_score_refitted;
        entry.difference = strongest->difference;
        entries.push_back(entry);
        first = last;
    }
}

}  // namespace

Location locate(const GapSpace& space, const GapData& data, const NullDistribution& null,
                const Eigen::VectorXd& gap, const Grid& grid, const Limits& limits) {
    Location location;
    location.threshold = null.quantile(&GapStatistics::highest_refitted, limits.false_alarm);
    const auto all = cells_of(grid);
    const Eigen::VectorXd refitted = space.refitted(gap);
    std::vector<std::vector<WhereCell>> rows(2 * observables().size());
    for (std::size_t k = 0; k < data.cells.size(); ++k) {
        const Cell& cell = all[data.cells[k]];
        const double sigma = space.sigma()[k];
        WhereCell where{std::string(observables()[cell.observable].name),
                        std::string(name(cell.phase)),
                        cell.displacement,
                        gap[data.cells[k]] / sigma,
                        refitted[k] / sigma,
                        gap[data.cells[k]]};
        location.cells.push_back(where);
        rows[2 * static_cast<std::size_t>(cell.observable) + (cell.phase == Phase::load ? 0 : 1)].push_back(
            where);
    }
    const double half_spacing =
        grid.displacement.size() > 1 ? 0.5 * (grid.displacement[1] - grid.displacement[0]) : 0.5 * grid.width;
    for (std::size_t r = 0; r < rows.size(); ++r)
        gather_ranges(rows[r], location.threshold, half_spacing, observables()[r / 2], location.entries);
    for (WhereEntry& entry : location.entries)
        entry.displacement[1] = std::min(entry.displacement[1], grid.stroke);
    std::ranges::stable_sort(location.entries, [](auto& a, auto& b) {
        return std::abs(a.z_score_refitted) > std::abs(b.z_score_refitted);
    });
    return location;
}

}  // namespace mcdem::diagnose
