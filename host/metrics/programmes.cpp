#include "metrics/programmes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/container.h"
#include "core/parameters.h"
#include "metrics/stress_strain.h"

namespace mcdem::inline metrics {

bool follows_programme(const Recording& recording) { return has_programme(recording.parameters); }

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

bool are_cells(const Replicas& replicas) { return !replicas.empty() && is_cell(replicas.front()->box); }

bool has_hold(const Replicas& replicas) {
    return std::ranges::any_of(replicas, [](const Recording* recording) {
        return std::ranges::any_of(recording->parameters, [](const auto& parameter) {
            const auto& [key, value] = parameter;
            return key.starts_with("programme.") && key.ends_with(".stage") &&
                   without_quotes(value) == "hold";
        });
    });
}

namespace {

/// A scan and its replica.
struct Seen {
    const Recording* recording;
    const Scan* scan;
};

MeanScan mean_of(int frame, const std::vector<Seen>& scans) {
    const auto mean = [&](const auto& quantity) {
        std::vector<double> values;
        for (const auto& [recording, scan] : scans) values.push_back(quantity(*recording, *scan));
        return mean_over_replicas(values);
    };
    const auto of_scan = [&](const auto& quantity) {
        return mean([&](const Recording&, const Scan& scan) { return quantity(scan); });
    };
    MeanScan means;
    means.frame = frame;
    means.cycle = scans.front().scan->cycle;
    means.phase = scans.front().scan->phase;
    means.time = of_scan([](const Scan& scan) { return scan.time; });
    means.displacement = mean([](const Recording& r, const Scan& scan) { return r.displacement(scan); });
    means.top_force = of_scan([](const Scan& scan) { return scan.top_force(); });
    means.coordination = of_scan([](const Scan& scan) { return scan.coordination_number; });
    means.packing_fraction = of_scan([](const Scan& scan) { return scan.packing_fraction; });
    means.p = of_scan([](const Scan& scan) { return mean_stress(scan.stress); });
    means.q = of_scan([](const Scan& scan) { return deviatoric_stress(scan.stress); });
    for (std::size_t k = 0; k < means.strain.size(); ++k)
        means.strain[k] = of_scan([&](const Scan& scan) { return scan.strain[k]; });
    means.volume_strain = of_scan([](const Scan& scan) { return volume_strain(scan.strain); });
    means.shear_strain = of_scan([](const Scan& scan) { return deviatoric_strain(scan.strain); });
    for (const Seen& seen : scans) means.max_overlap = std::fmax(means.max_overlap, seen.scan->max_overlap);
    return means;
}

}  // namespace

std::vector<MeanScan> mean_scans(const Replicas& replicas) {
    std::map<int, std::vector<Seen>> by_frame;
    for (const auto* recording : replicas)
        for (const Scan& scan : recording->scans) by_frame[scan.frame].push_back({recording, &scan});
    std::vector<MeanScan> means;
    for (const auto& [frame, scans] : by_frame) means.push_back(mean_of(frame, scans));
    return means;
}

}  // namespace mcdem::metrics
