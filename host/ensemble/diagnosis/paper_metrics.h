// Metrics of the paper for an experiment compared with the scene, and with the scene plus the named effect.
#pragma once
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/recording.h"

namespace mcdem::inline ensemble {

struct BeforeAfter {
    std::vector<Recording> before, after;  ///< replicates, as measured
};

struct PaperMetrics {
    /// Rtop, errf [N], errZ, bhat, as far as known: name; before and after.
    std::vector<std::pair<std::string, std::array<double, 2>>> values;
    /// Displacement [m], experiment, before and after [N], during loading.
    std::vector<std::array<double, 4>> top_force;
};

PaperMetrics paper_metrics(const Recording& experiment, const BeforeAfter& simulated);

}  // namespace mcdem::ensemble
