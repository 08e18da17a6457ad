#include "metrics/programmes.h"

#include <algorithm>
#include <map>

namespace mcdem::inline metrics {

bool follows_programme(const Recording& recording) {
    return recording.parameters.contains("programme.1.stage");
}

bool follows_programme(const Replicas& replicas) {
    return std::ranges::any_of(replicas,
                               [](const Recording* recording) { return follows_programme(*recording); });
}

std::vector<Setting> with_programme(const std::vector<Setting>& settings, bool programme) {
    std::vector<Setting> some;
    for (const Setting& setting : settings)
        if (follows_programme(setting.replicas) == programme) some.push_back(setting);
    return some;
}

std::vector<MeanScan> mean_scans(const Replicas& replicas) {
    struct Values {
        const Scan* first;
        std::vector<double> time, displacement, top_force, coordination;
    };
    std::map<int, Values> by_frame;
    for (const auto* recording : replicas)
        for (const Scan& scan : recording->scans) {
            Values& values = by_frame.try_emplace(scan.frame, Values{&scan, {}, {}, {}, {}}).first->second;
            values.time.push_back(scan.time);
            values.displacement.push_back(recording->displacement(scan));
            values.top_force.push_back(scan.top_force());
            values.coordination.push_back(scan.coordination_number);
        }
    std::vector<MeanScan> means;
    for (const auto& [frame, values] : by_frame)
        means.push_back({frame, values.first->cycle, values.first->phase, mean_over_replicas(values.time),
                         mean_over_replicas(values.displacement), mean_over_replicas(values.top_force),
                         mean_over_replicas(values.coordination)});
    return means;
}

}  // namespace mcdem::metrics
