// Compression strokes of the authors' packing, in many replicas whose starting positions differ by the
// measurement error: single runs are chaotic and scatter by several per cent.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/recording.h"
#include "scene/scene.h"

namespace reference {

inline const std::filesystem::path authors_folder = std::filesystem::path(MCDEM_SHARED_DATA) / "hydrogel";

#define SKIP_WITHOUT_AUTHORS_PACKING()                           \
    if (!std::filesystem::exists(authors_folder / "input.data")) \
    GTEST_SKIP() << "no authors' packing: " << authors_folder << " is missing"

/// The other code's settings: one continuous stroke of 0.3 s, friction with history, no relaxation before.
mcdem::Replica authors_replica(mcdem::ContactModel model, int scans_per_stroke);

/// Top force by scan of a loading stroke [N].
using Curve = std::vector<double>;

/// Mean over replicas and its standard error, by scan.
struct MeanCurve {
    Curve mean, standard_error;
    int replicas = 0;  ///< that came to the end
};

struct Setting {
    mcdem::Replica replica;
    mcdem::Precision precision = mcdem::Precision::single_precision;
};

/// Loading stroke of every setting from `replicas` starts; replica 0 of one replica starts from the packing
/// as it is, otherwise every start is jittered by 0.1 mm, the same jitters for every setting.
std::map<std::string, MeanCurve> loading_strokes(const std::map<std::string, Setting>& settings,
                                                 int replicas);

}  // namespace reference
