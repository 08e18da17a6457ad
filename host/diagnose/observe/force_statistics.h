// Observables of the forces in one scan: forces on walls, distribution, direction and friction.
#pragma once
#include <array>
#include <span>

#include "diagnose/observe/contact_residuals.h"

namespace mcdem::inline diagnose {

/// Scans with fewer contacts give no values.
inline constexpr std::size_t min_contacts = 60;

// Each in the order of the table in scan_observables.cpp; NaN if the scan does not determine it.

/// Forces on floor, sides and plate over the plate's reading, and the moment on the plate.
std::array<double, 5> wall_loads(const Recording& recording, const Scan& scan);

/// Z, weak contacts, log <f>, spread, weak, strong and maximum forces.
std::array<double, 7> force_distribution_numbers(const Recording& recording, const Scan& scan,
                                                 const ReferenceMaterial& material);

/// Vertical force through a horizontal section plus the friction of the side walls above it, mean over all
/// sections, over the plate's reading. At rest it is 1 (minus the weight above), whatever the material.
double section_load(const Scan& scan);

/// Anisotropy, vertical gradient, non-affine displacement, fraction of attractive contacts.
std::array<double, 4> fabric(const Recording& recording, const Scan& scan,
                             std::span<const ContactResidual> contacts);

/// f_t/f_n between grains (mean, high, sliding) and at walls (mean, high); unbalanced torque.
std::array<double, 6> friction_numbers(const Recording& recording, const Scan& scan,
                                       std::span<const ContactResidual> contacts,
                                       const ReferenceMaterial& material);

}  // namespace mcdem::diagnose
