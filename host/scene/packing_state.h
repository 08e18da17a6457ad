// Overlaps and contacts of an initial packing.
#pragma once
#include "core/packing.h"
#include "scene/plate_face.h"

namespace mcdem::inline scene {

struct PackingState {
    double coordination_number = 0;  ///< contacts per grain, including those with walls and plate
    double deepest_overlap = 0;      ///< [m]
    double relative_overlap = 0;     ///< deepest overlap over the diameter of the smaller grain
};

PackingState packing_state(const Packing& packing, const Box& box, const PlateFace& plate);

}  // namespace mcdem::scene
