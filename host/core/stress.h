// Stress and fabric of a packing, from the places and forces of its contacts.
#pragma once
#include <vector>

#include "core/recording.h"

// `box` is the container as it is at start; a cell is deformed by the scan's strain.

namespace mcdem::inline core {

/// Stress of each grain [Pa]: minus the sum over its contacts of (contact point - centre) times force on the
/// grain, over the volume of the undeformed sphere (Love 1927, Weber 1966). Row: direction of the branch;
/// column: of the force. Compression is positive. Throws
/// InputError where the scan has no positions, or its contacts are not known.
std::vector<Mat3> grain_stress(const Box& box, const std::vector<double>& diameter, const Scan& scan);

/// The same sum over all grains, over the volume between floor and plate, or that of a cell [Pa]. At rest and
/// without weight it is symmetric, and where walls have no friction its diagonal is the wall forces over the
/// walls' areas.
Mat3 packing_stress(const Box& box, const Scan& scan);

/// The forces through the faces of a cell with these lengths now, as on walls in their places: area times
/// stress [N].
std::array<Vec3, wall_count> face_forces(const Box& now, const Mat3& stress);

/// Mean of n times n, n the direction from centre to centre, over the contacts between grains (Satake 1982).
/// Its trace is one; not-a-number where there are none.
Mat3 packing_fabric(const Box& box, const Scan& scan);

/// The part of a contact's force along the line from the grain's centre to its partner's, or to the wall; the
/// tangential force is the rest. Positive where it presses [N].
double normal_force(const Box& box, const Scan& scan, const Contact& contact);

}  // namespace mcdem::core
