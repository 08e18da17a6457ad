// Averages of a scan from positions and contacts: Z, <f>, phi and <b> of the paper.
#pragma once
#include "core/recording.h"

namespace mcdem::inline sim {

/// Fills coordination_number, mean_force and branch_length of `scan` (from contacts at or above
/// `force_threshold` [N]; NaN without contacts), max_overlap, stress and fabric (all contacts) and
/// packing_fraction. A contact between grains counts for both grains, a contact with a wall for its grain.
void fill_averages(Scan& scan, const Box& box, const std::vector<double>& diameter, double force_threshold);

/// Volume of the grains in the region more than a mean diameter from every wall, over the volume of the
/// region. Grains that its border cuts are counted with a fixed set of sample points. NaN if the box has no
/// such region.
double packing_fraction(const std::vector<Vec3>& position, const std::vector<double>& diameter,
                        const Box& box, double plate_z);

}  // namespace mcdem::sim
