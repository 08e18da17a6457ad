// Rearrangements of grains that occur in no replicate. They change all observables at one displacement, and
// few elsewhere; an effect changes observables in the whole stroke.
#pragma once
#include "diagnose/infer/gap_tests.h"

namespace mcdem::inline diagnose {

/// The cells without all observables at one displacement and phase (`place`, the index of a cell in its
/// observable), except relaxation and creep in a hold, which have one place only.
CellChoice without_place(const CellChoice& cells, int place, Eigen::Index all_cells);

/// Tests without one place.
struct PlaceLeftOut {
    int place = 0;
    CellChoice cells;
    NullDistribution null;
};

/// One for each place, unless too few other cells remain.
std::vector<PlaceLeftOut> places_left_out(const GapData& data, int mean_of, std::uint64_t seed);

/// p of a gap, from the omnibus and the directed test (Bonferroni correction).
double p_of_gap(const NullDistribution& null, const GapStatistics& statistics);

/// The largest p of the gap without one of the places.
double p_without_one_place(const std::vector<PlaceLeftOut>& places, const GapData& data, int mean_of);

}  // namespace mcdem::diagnose
