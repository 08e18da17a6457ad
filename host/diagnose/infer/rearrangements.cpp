#include "diagnose/infer/rearrangements.h"

#include <algorithm>

#include "diagnose/observe/needed_to_diagnose.h"
#include "diagnose/observe/scan_observables.h"

namespace mcdem::inline diagnose {

std::vector<PlaceLeftOut> places_left_out(const GapData& data, int mean_of, std::uint64_t seed) {
    const Eigen::Index relaxation = index_of(OfProgramme::relaxation), creep = index_of(OfProgramme::creep);
    const Eigen::Index places = data.gap.size() / static_cast<Eigen::Index>(observables().size());
    std::vector<PlaceLeftOut> list;
    GapData rest = data;
    for (Eigen::Index k = 0; k < places; ++k) {
        rest.cells.clear();
        for (const auto cell : data.cells) {
            const Eigen::Index observable = cell / places;
            if (cell % places != k || observable == relaxation || observable == creep)
                rest.cells.push_back(cell);
        }
        if (rest.cells.size() == data.cells.size() || rest.cells.size() < min_cells) continue;
        list.push_back({rest.cells, NullDistribution(rest, mean_of, seed)});
    }
    return list;
}

double p_of_gap(const NullDistribution& null, const GapStatistics& statistics) {
    return std::min(1.0, 2 * std::min(null.p_value(&GapStatistics::omnibus, statistics.omnibus),
                                      null.p_value(&GapStatistics::directed, statistics.directed)));
}

double p_without_one_place(const std::vector<PlaceLeftOut>& places, const GapData& data, int mean_of) {
    double largest = 0;
    for (const auto& [cells, null] : places) {
        const GapSpace space(data.noise, mean_of, cells, data.free);
        largest = std::max(largest, p_of_gap(null, gap_statistics(space, data, data.gap)));
    }
    return largest;
}

}  // namespace mcdem::diagnose
