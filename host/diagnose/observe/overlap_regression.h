// What the difference between implied and measured overlaps depends on, between grains and at walls.
#pragma once
#include <array>
#include <span>

#include "diagnose/observe/contact_residuals.h"

namespace mcdem::inline diagnose {

// Each in the order of the table of scan_observables.cpp, not-a-number where the scan does not tell.

/// Contacts per grain across a gap, and overlaps without a contact.
std::array<double, 2> contact_occurrence(const Recording& recording, const Scan& scan,
                                         std::span<const ContactResidual> contacts);

/// Regression on 1, implied overlap, its square and the cross-contact sum; spread of the remainders, and what
/// those of one grain have in common, as such and in proportion to the overlap.
std::array<double, 7> grain_overlaps(const Recording& recording, std::span<const ContactResidual> contacts);

/// Sides: offset and slope; floor: mean; plate: mean, slopes along x and y.
std::array<double, 6> wall_overlaps(const Recording& recording, const Scan& scan,
                                    std::span<const ContactResidual> contacts);

}  // namespace mcdem::diagnose
