// The comparison table of the paper: replicas of one setting against reference recordings, measured or
// simulated.
#pragma once
#include "metrics/levels.h"

namespace mcdem::inline metrics {

struct Comparison {
    std::string setting;
    Estimate Rtop;  ///< top force at maximum compression over that of the reference
    Estimate errf;  ///< RMS error of the top force over all levels [N]
    Estimate errZ;  ///< RMS error of Z over all levels, at tau
    Estimate tau;   ///< force below which contacts are ignored, chosen to minimise errZ [N]
    Estimate bhat;  ///< -log of the mean over levels of the Bhattacharyya coefficient
    int replicas = 0;
    int reference_levels = 0;
    int levels_errf = 0, levels_errZ = 0, levels_bhat = 0;  ///< number of levels used for each
    std::vector<std::string> notes;                         ///< unavailable data, and what was done instead
};

/// errf ignores levels at which the reference's force does not exceed `touch_force` [N].
Comparison compare(const Setting& simulated, const Replicas& reference,
                   std::optional<double> touch_force = std::nullopt);

}  // namespace mcdem::metrics
