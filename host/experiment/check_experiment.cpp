#include "experiment/check_experiment.h"

#include <fmt/format.h>

#include <array>
#include <numeric>

#include "core/container.h"
#include "experiment/findings.h"

namespace mcdem::inline experiment {

std::string Tally::text() const {
    return fmt::format("{} in {} frame{}, first in frame {}: {}", count_, frames_, frames_ == 1 ? "" : "s",
                       first_, example_);
}

const std::vector<Wall>& walls_of(const Box& box) {
    static const auto by_shape = [] {
        std::array<std::vector<Wall>, name_list<ContainerShape>.size()> lists;
        for (std::size_t shape = 0; shape < lists.size(); ++shape)
            for (int wall = 0; wall < wall_count; ++wall) {
                Box any;
                any.shape = static_cast<ContainerShape>(shape);
                if (has_wall(any, static_cast<Wall>(wall))) lists[shape].push_back(static_cast<Wall>(wall));
            }
        return lists;
    }();
    return by_shape[static_cast<std::size_t>(box.shape)];
}

std::string container_words(const Box& box) {
    if (is_cylinder(box))
        return fmt::format("cylinder with a radius of {:.6g} mm", 1e3 * cylinder_radius(box));
    return fmt::format("{} of {:.6g} by {:.6g} mm", is_periodic(box) ? "periodic container" : "box",
                       1e3 * box.size_x, 1e3 * box.size_y);
}

double mean_diameter(const Recording& recording) {
    return std::accumulate(recording.diameter.begin(), recording.diameter.end(), 0.0) /
           static_cast<double>(recording.diameter.size());
}

std::optional<double> material(const Experiment& experiment, const std::string& key) {
    const auto found = experiment.materials.find(key);
    return found == experiment.materials.end() ? std::nullopt : std::optional(found->second);
}

std::vector<std::string> ExperimentCheck::of(Severity severity) const {
    std::vector<std::string> texts;
    for (const Finding& finding : findings)
        if (finding.severity == severity) texts.push_back(finding.text);
    return texts;
}

ExperimentCheck check_experiment(const Experiment& experiment) {
    Findings findings;
    for (const auto check : {describe, find_missing, check_errors, check_plate, check_grains, check_contacts,
                             check_plate_load, check_balance})
        check(experiment, findings);
    ExperimentCheck result{findings.all()};
    std::ranges::stable_sort(result.findings,
                             [](const Finding& a, const Finding& b) { return a.severity < b.severity; });
    return result;
}

}  // namespace mcdem::experiment
