#include "diagnose/infer/rearrangements.h"

#include <algorithm>

#include "diagnose/observe/needed_to_diagnose.h"
#include "diagnose/observe/scan_observables.h"

namespace mcdem::inline diagnose {

CellChoice without_place(const CellChoice& cells, int place, Eigen::Index all_cells) {
    const Eigen::Index relaxation = index_of(OfProgramme::relaxation), creep = index_of(OfProgramme::creep);
    const Eigen::Index each = cells_each(all_cells);
    CellChoice rest;
    for (const auto cell : cells) {
        const Eigen::Index observable = cell / each;
        if (cell % each != place || observable == relaxation || observable == creep) rest.push_back(cell);
    }
    return rest;
}

std::vector<PlaceLeftOut> places_left_out(const GapData& data, int mean_of, std::uint64_t seed) {
    std::vector<PlaceLeftOut> list;
    GapData rest = data;
    for (int place = 0; place < cells_each(data.gap.size()); ++place) {
        rest.cells = without_place(data.cells, place, data.gap.size());
        if (rest.cells.size() == data.cells.size() || rest.cells.size() < min_cells) continue;
        list.push_back({place, rest.cells, NullDistribution(rest, mean_of, seed)});
    }
    return list;
}

double p_of_gap(const NullDistribution& null, const GapStatistics& statistics) {
    return std::min(1.0, 2 * std::min(null.p_value(&GapStatistics::omnibus, statistics.omnibus),
                                      null.p_value(&GapStatistics::directed, statistics.directed)));
}

double p_without_one_place(const std::vector<PlaceLeftOut>& places, const GapData& data, int mean_of) {
    double largest = 0;
    for (const auto& [_, cells, null] : places) {
        const GapSpace space(data.noise, mean_of, cells, data.free);
        largest = std::max(largest, p_of_gap(null, gap_statistics(space, data, data.gap)));
    }
    return largest;
}

}  // namespace mcdem::diagnose
