// Sums over the contacts of each grain in a scan.
#pragma once
#include <vector>

#include "core/recording.h"

namespace mcdem::inline io {

struct GrainLoad {
    int contacts = 0;                ///< including walls
    double force_magnitude = 0;      ///< sum over all contacts [N]
    Vec3 wall_force = Vec3::Zero();  ///< total force by walls [N]
};

/// By grain; all zero if contacts were not recorded.
std::vector<GrainLoad> grain_loads(const Scan& scan);

}  // namespace mcdem::io
