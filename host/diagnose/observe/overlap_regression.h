// Regression of the difference between implied and measured overlaps, between grains and at walls.
#pragma once
#include <array>
#include <span>

#include "diagnose/observe/contact_residuals.h"

namespace mcdem::inline diagnose {

// Each in the order of the table in scan_observables.cpp; NaN if the scan does not determine it.

/// Contacts per grain across a gap, and overlaps without contact.
std::array<double, 2> contact_occurrence(const Recording& recording, const Scan& scan,
                                         std::span<const ContactResidual> contacts);

/// Regression on 1, implied overlap, its square and the cross-contact sum; scatter of the residuals, and
/// their common part for the contacts of one grain, both absolute and in proportion to the overlap.
std::array<double, 7> grain_overlaps(const Recording& recording, std::span<const ContactResidual> contacts);

/// Sides: offset and slope; floor: mean; plate: mean, slopes along x and y.
std::array<double, 6> wall_overlaps(const Recording& recording, const Scan& scan,
                                    std::span<const ContactResidual> contacts);

}  // namespace mcdem::diagnose
