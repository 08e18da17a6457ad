// What a packing is like before anything moves.
#pragma once
#include "core/packing.h"
#include "scene/plate_face.h"

namespace mcdem::inline scene {

struct PackingState {
    double coordination_number = 0;  ///< contacts a grain, those with walls and plate included
    double deepest_overlap = 0;      ///< [m]
    double relative_overlap = 0;     ///< the deepest over the diameter of the smaller grain
};

PackingState packing_state(const Packing& packing, const Box& box, const PlateFace& plate);

}  // namespace mcdem::scene
