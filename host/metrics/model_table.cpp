#include "metrics/model_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "metrics/stress_strain.h"
#include "metrics/top_force.h"

namespace mcdem::inline metrics {
namespace {

const Setting& reference_of(const std::vector<Setting>& settings, const std::optional<std::string>& label) {
    const auto found = std::find_if(settings.begin(), settings.end(), [&](const Setting& setting) {
        return label ? setting.label == *label : model_of(setting.replicas) == ContactModel::mc_dem;
    });
    if (found != settings.end()) return *found;
    if (!label) return settings.front();
    std::string known;
    for (const auto& setting : settings)
        known += fmt::format("{}\"{}\"", known.empty() ? "" : ", ", setting.label);
    throw InputError(fmt::format("reference setting: must be one of {}; got \"{}\"", known, *label));
}

/// The largest displacement of all replicas that did not stop early; NaN if all did.
double largest_stroke(const std::vector<Setting>& settings) {
    double largest = not_available;
    for (const auto& setting : settings)
        largest = std::fmax(largest, full_stroke(group_levels(setting.replicas), setting.replicas));
    return largest;
}

/// Displacement of the last scan, including replicas that stopped early.
double last_scan(const Levels& levels) {
    double last = not_available;
    for (const auto& level : levels) last = std::fmax(last, level.displacement);
    return last;
}

}  // namespace

double largest_rate_error(const Replicas& replicas) {
    double largest = not_available;
    for (const Recording* recording : replicas) {
        double top = 0;
        for (const Scan& scan : recording->scans) top = std::fmax(top, load(*recording, scan));
        for (const Scan& scan : recording->scans)
            if (load(*recording, scan) >= 0.1 * top) largest = std::fmax(largest, scan.rate_error);
    }
    return largest;
}

ModelTable model_table(const std::vector<Setting>& settings, const std::optional<std::string>& reference) {
    ModelTable table;
    if (settings.empty()) return table;
    const auto& over = reference_of(settings, reference);
    const auto over_levels = group_levels(over.replicas);
    table.reference = over.label;
    table.displacement = full_stroke(over_levels, over.replicas);
    if (std::isnan(table.displacement)) table.displacement = largest_stroke(settings);
    for (const auto& setting : settings) {
        const auto levels = group_levels(setting.replicas);
        const auto at = [&](double displacement) {
            const auto above = top_force_at(levels, setting.replicas, displacement);
            const auto below = top_force_at(over_levels, over.replicas, displacement);
            return ModelRow{setting.label, model_of(setting.replicas), mean_over_replicas(above.value),
                            ratio_of_means(above, below), static_cast<int>(setting.replicas.size())};
        };
        ModelRow row = at(table.displacement);
        if (const double last = last_scan(levels); !row.top_force.available() && std::isfinite(last)) {
            row = at(last);
            row.reached = last;
        }
        for (const auto* recording : setting.replicas) row.failed += recording->failure.has_value();
        row.beyond = beyond_law(setting.replicas);
        table.rate_error = std::fmax(table.rate_error, largest_rate_error(setting.replicas));
        table.rows.push_back(row);
    }
    return table;
}

}  // namespace mcdem::metrics
