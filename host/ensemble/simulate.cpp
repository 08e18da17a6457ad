#include "ensemble/simulate.h"

#include <algorithm>

#include "sim/simulation.h"

namespace mcdem::inline ensemble {

std::vector<Recording> simulate(Device& device, const Scene& scene, const std::vector<Packing>& packings,
                                std::size_t scans_needed,
                                const std::function<void(double fraction)>& on_progress) {
    std::vector<Recording> recordings;
    for (std::size_t r = 0; r < packings.size(); ++r)
        recordings.push_back(begin_recording(scene.replicas[r], packings[r]));
    const auto keep = [&](int r, Scan scan) { recordings[r].scans.push_back(std::move(scan)); };
    const auto note = [&](int r, const Failure& failure) { recordings[r].failure = failure; };
    const auto complete = [&](const Recording& recording) {
        return recording.failure || recording.scans.size() >= scans_needed;
    };
    Simulation simulation(device, scene, packings);
    while (!std::all_of(recordings.begin(), recordings.end(), complete) && simulation.advance(keep, note))
        on_progress(simulation.progress());
    return recordings;
}

}  // namespace mcdem::ensemble
