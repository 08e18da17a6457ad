// The averages of a scan, from positions and contacts: what the paper calls Z, <f>, phi and <b>.
#pragma once
#include "core/recording.h"

namespace mcdem::inline sim {

/// Fills coordination_number, mean_force and branch_length (contacts at or above `force_threshold` [N];
/// not-a-number where there are none), max_overlap, stress and fabric (all contacts) and packing_fraction of
/// `scan`. A contact between grains counts for both, a contact with a wall for its grain.
void fill_averages(Scan& scan, const Box& box, const std::vector<double>& diameter, double force_threshold);

/// Volume of the grains inside the region more than a mean diameter from every wall, over the region's
/// volume. Grains cut by its border count by a fixed set of sample points. Not-a-number where the box
/// leaves no such region.
double packing_fraction(const std::vector<Vec3>& position, const std::vector<double>& diameter,
                        const Box& box, double plate_z);

}  // namespace mcdem::sim
