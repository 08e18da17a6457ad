// Runs of a programme: scans one after the other, in place of strokes sorted into levels.
#pragma once
#include "metrics/estimate.h"
#include "metrics/replicas.h"

namespace mcdem::inline metrics {

/// Whether the recording was taken through a [[programme]].
bool follows_programme(const Recording& recording);

/// Whether any of the recordings was.
bool follows_programme(const Replicas& replicas);

/// The settings that do, or those that do not.
std::vector<Setting> with_programme(const std::vector<Setting>& settings, bool programme);

/// The same scan of all replicas that have it.
struct MeanScan {
    int frame = 0;
    int cycle = 0;
    Phase phase = Phase::load;
    Estimate time, displacement, top_force, coordination;  ///< [s], [m], [N], 1
};

std::vector<MeanScan> mean_scans(const Replicas& replicas);

}  // namespace mcdem::metrics
