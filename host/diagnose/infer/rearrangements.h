// Rearrangements of grains that occur in no replicate. They change all observables at one displacement, and
// few elsewhere; an effect changes observables in the whole stroke.
#pragma once
#include "diagnose/infer/gap_tests.h"

namespace mcdem::inline diagnose {

/// Tests without all observables at one displacement and phase.
struct PlaceLeftOut {
    CellChoice cells;
    NullDistribution null;
};

/// One for each displacement and phase. Relaxation and creep in a hold remain: they have one place only.
/// Places are kept if too few other cells would remain.
std::vector<PlaceLeftOut> places_left_out(const GapData& data, int mean_of, std::uint64_t seed);

/// p of a gap, from the omnibus and the directed test (Bonferroni correction).
double p_of_gap(const NullDistribution& null, const GapStatistics& statistics);

/// The largest p of the gap if one place is left out.
double p_without_one_place(const std::vector<PlaceLeftOut>& places, const GapData& data, int mean_of);

}  // namespace mcdem::diagnose
