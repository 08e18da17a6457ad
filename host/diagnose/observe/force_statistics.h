// Numbers that describe the forces of one scan: on walls, their distribution, direction and friction.
#pragma once
#include <array>
#include <span>

#include "diagnose/observe/contact_residuals.h"

namespace mcdem::inline diagnose {

/// Fewer contacts in a scan say nothing.
inline constexpr std::size_t min_contacts = 60;

// Each in the order of the table of scan_observables.cpp, not-a-number where the scan does not tell.

/// Floor, side and plate forces over the plate's reading, and the plate's couple.
std::array<double, 5> wall_loads(const Recording& recording, const Scan& scan);

/// Z, weak contacts, log <f>, spread, weak, strong and strongest forces.
std::array<double, 7> force_distribution_numbers(const Recording& recording, const Scan& scan,
                                                 const ReferenceMaterial& material);

/// Vertical force through a horizontal section and that of the side walls' friction above it, mean over all
/// sections, over the plate's reading: at rest it is 1 (less the weight above), whatever the grains are made
/// of.
double section_load(const Scan& scan);

/// Anisotropy, vertical gradient, non-affine displacement, part of the contacts that pull.
std::array<double, 4> fabric(const Recording& recording, const Scan& scan,
                             std::span<const ContactResidual> contacts);

/// f_t/f_n between grains (mean, high, sliding) and at walls (mean, high); torque that does not cancel.
std::array<double, 6> friction_numbers(const Recording& recording, const Scan& scan,
                                       std::span<const ContactResidual> contacts,
                                       const ReferenceMaterial& material);

}  // namespace mcdem::diagnose
