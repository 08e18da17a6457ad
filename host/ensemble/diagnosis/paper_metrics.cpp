#include "ensemble/diagnosis/paper_metrics.h"

#include "metrics/compare.h"

namespace mcdem::inline ensemble {
namespace {

void add(PaperMetrics& metrics, const char* metric, const Estimate& before, const Estimate& after) {
    if (before.available() && after.available())
        metrics.values.push_back({metric, {before.value, after.value}});
}

}  // namespace

PaperMetrics paper_metrics(const Recording& experiment, const BeforeAfter& simulated) {
    PaperMetrics metrics;
    const Replicas reference{&experiment};
    const Setting settings[] = {{"before", replicas_of(simulated.before)},
                                {"after", replicas_of(simulated.after)}};
    const Comparison before = compare(settings[0], reference), after = compare(settings[1], reference);
    add(metrics, "Rtop", before.Rtop, after.Rtop);
    add(metrics, "errf", before.errf, after.errf);
    add(metrics, "errZ", before.errZ, after.errZ);
    add(metrics, "bhat", before.bhat, after.bhat);

    const Levels measured = group_levels(reference);
    Eigen::ArrayXd forces[2];
    for (int k = 0; k < 2; ++k) {
        const Levels levels = group_levels(settings[k].replicas);
        const auto matches = match_levels(levels, measured);
        forces[k] = mean_without(at_reference(by_replica(levels, top_force), matches), -1);
    }
    const Eigen::ArrayXd experiment_force = mean_without(by_replica(measured, top_force), -1);
    for (std::size_t level = 0; level < measured.size(); ++level) {
        if (measured[level].phase == Phase::load)
            metrics.top_force.push_back(
                {measured[level].displacement, experiment_force[level], forces[0][level], forces[1][level]});
    }
    return metrics;
}

}  // namespace mcdem::ensemble
