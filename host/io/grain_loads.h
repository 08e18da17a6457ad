// What the contacts of a scan are to each of its grains.
#pragma once
#include <vector>

#include "core/recording.h"

namespace mcdem::inline io {

struct GrainLoad {
    int contacts = 0;                ///< walls counted
    double force_magnitude = 0;      ///< sum over them [N]
    Vec3 wall_force = Vec3::Zero();  ///< by the walls [N]
};

/// By grain; all zero where contacts were not recorded.
std::vector<GrainLoad> grain_loads(const Scan& scan);

}  // namespace mcdem::io
