// Stress and fabric of a packing, from the positions and forces of its contacts.
#pragma once
#include <vector>

#include "core/recording.h"

// `box` is the initial container; a cell is deformed by the scan's strain.

namespace mcdem::inline core {

/// Stress of each grain [Pa]: minus the sum over its contacts of (contact point - centre) times force on the
/// grain, over the volume of the undeformed sphere (Love 1927, Weber 1966). Row: direction of the branch;
/// column: direction of the force. Compression is positive. Throws InputError if the scan has no positions,
/// or its contacts are unknown.
std::vector<Mat3> grain_stress(const Box& box, const std::vector<double>& diameter, const Scan& scan);

/// The same sum over all grains, over the volume between floor and plate or that of a cell [Pa]. At rest and
/// without weight it is symmetric; with frictionless walls its diagonal equals the wall forces over the areas
/// of the walls.
Mat3 packing_stress(const Box& box, const Scan& scan);

/// Forces through the faces of a cell with the current lengths `now`, in the order of the walls: area times
/// stress [N].
std::array<Vec3, wall_count> face_forces(const Box& now, const Mat3& stress);

/// Mean of n times n over the contacts between grains, n the direction between the centres (Satake 1982). Its
/// trace is one; NaN if there are no contacts.
Mat3 packing_fabric(const Box& box, const Scan& scan);

}  // namespace mcdem::core
