// What a run of a replica is expected to need, from the sizes of its grains alone: steps, and the force on
// the plate.
#pragma once
#include <optional>

#include "sim/quasi_static.h"

namespace mcdem::inline sim {

/// Estimates of the vertical stress in a packing below a plate at z [m]. Affine deformation of Hertz contacts
/// (Walton 1987, J. Mech. Phys. Solids 35, 213): with the compression e = 1 - c/fraction from a packing
/// without force, overlaps are d e/3, and the pressure is fraction Z F/(pi d^2). `low`: c = 0.64, Z = 6.
/// `high`: c = 0.58, Z = 8, a vertical stress of 1.5 times the mean stress, and twice that for the
/// displacements of surfaces by other contacts, unless neglected. Walls keep grains apart: c is smaller by
/// 0.107 d times their area over the volume, as the limits of generated packings are
/// (scene/packing/generate_packing.h).
struct PressureRange {
    double low = 0, high = 0;
};
PressureRange expected_pressure(const Replica& replica, const PackingScale& scale, double z);

struct ExpectedRun {
    double relax_steps = 0;      ///< at most
    double programme_steps = 0;  ///< in steps that are not shortened
    double lowest = 0;           ///< position of the plate [m]
    PressureRange at_lowest;     ///< unless a force is prescribed, or a cell
};
/// `time_step` [s]
ExpectedRun expected_run(const Replica& replica, const PackingScale& scale, double time_step);

/// Estimated duration of a stage's moves and holds each time it runs, at its maximum speed [s].
double seconds_of_stage(const Stage& stage, const Replica& replica);

/// The scale of the replica's packing before it is generated: all grains touch its expected height.
PackingScale expected_scale(const Replica& replica);

}  // namespace mcdem::sim
