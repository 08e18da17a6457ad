// Compression strokes of the authors' packing, in many replicas whose initial positions differ by the
// measurement error. Single runs are chaotic and scatter by several per cent.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "authors_data.h"
#include "core/recording.h"
#include "scene/scene.h"

namespace mcdem::reference {

/// Settings of the other code: one continuous stroke of 0.3 s, the Mindlin friction that it has, no
/// relaxation before.
mcdem::Replica authors_replica(mcdem::ContactModel model, int scans_per_stroke);

/// Top force [N] in each scan of a loading stroke.
using Curve = std::vector<double>;

/// Mean over replicas and its standard error, for each scan.
struct MeanCurve {
    Curve mean, standard_error;
    int replicas = 0;  ///< that finished the stroke
};

struct Setting {
    mcdem::Replica replica;
    mcdem::Precision precision = mcdem::Precision::single_precision;
};

/// Loading stroke of each setting from `replicas` initial states. A single replica starts from the packing
/// itself; otherwise all positions are jittered by 0.1 mm, equally for all settings.
std::map<std::string, MeanCurve> loading_strokes(const std::map<std::string, Setting>& settings,
                                                 int replicas);

}  // namespace mcdem::reference
