#include <algorithm>

#include "experiment/check_experiment.h"

namespace mcdem::inline experiment {

std::vector<std::string> needed_to_diagnose(const Experiment& experiment) {
    const Recording& recording = experiment.recording;
    std::vector<std::string> needed;
    if (recording.scans.empty() || recording.scans.front().position.empty())
        needed.push_back(
            experiment.name +
            ": grains.csv must have the positions of frame 0: simulations start from them, and the "
            "force on a plate alone does not tell how the grains lie (a row: "
            "0,grain,x_m,y_m,z_m,diameter_m)");
    const bool loads = std::ranges::any_of(recording.scans, [&](const Scan& scan) {
        return scan.phase == Phase::load && scan.plate_z < recording.plate_start;
    });
    if (!loads) needed.push_back(experiment.name + ": plate.csv must have loading frames below plate.start");
    if (!(experiment.measurement.position_error > 0))
        needed.push_back(
            experiment.name +
            ": experiment.toml must state how well positions are known: replicates of the packing are "
            "moved by it, and without it they have no scatter to compare a gap with; add to "
            "[measurement] a line such as `position_error = 1e-4 # [m]`");
    return needed;
}

}  // namespace mcdem::experiment
