#include "diagnose/observe/needed_to_diagnose.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "diagnose/observe/observation.h"

namespace mcdem::inline diagnose {
namespace {

/// Points of the comparison without a force on the plate.
std::string missing_forces(const Recording& recording) {
    Recording plate;
    plate.plate_start = recording.plate_start;
    plate.parameters = recording.parameters;
    for (const Scan& scan : recording.scans) {
        Scan& one = plate.scans.emplace_back(scan);
        one.position.clear();
        one.contacts.clear();
    }
    const Grid grid = grid_of(plate);
    const auto known = static_cast<std::size_t>(observe(plate, grid, {}).array().isFinite().count());
    if (known >= min_cells) return "";
    std::vector<std::string> places;
    for (const double displacement : grid.displacement)
        places.push_back(fmt::format("{:.3g}", 1e3 * displacement));
    return fmt::format(
        "plate.csv must have frames with a force above 0 around {} mm of displacement, where it is compared "
        "while loading and unloading: {} of these {} places have one, and {} are needed",
        fmt::join(places, ", "), known, 2 * places.size(), min_cells);
}

}  // namespace

std::vector<std::string> needed_to_diagnose(const Experiment& experiment) {
    const Recording& recording = experiment.recording;
    std::vector<std::string> needed;
    if (recording.scans.empty() || recording.scans.front().position.empty())
        needed.push_back(
            "grains.csv must have the positions of frame 0: simulations start from them, and the force on a "
            "plate does not determine the positions (a row: 0,grain,x_m,y_m,z_m,diameter_m)");
    const bool loads = std::ranges::any_of(recording.scans, [&](const Scan& scan) {
        return scan.phase == Phase::load && scan.plate_z < recording.plate_start;
    });
    if (!loads)
        needed.push_back("plate.csv must have loading frames below plate.start");
    else if (const std::string forces = missing_forces(recording); !forces.empty())
        needed.push_back(forces);
    if (!(experiment.measurement.position_error > 0))
        needed.push_back(
            "experiment.toml must state how well positions are known: replicates of the packing are moved by "
            "it, and without it they have no scatter to compare a gap with; add to [measurement] a line such "
            "as `position_error = 1e-4 # [m]`");
    const bool has_contacts =
        std::ranges::any_of(recording.scans, [](const Scan& scan) { return !scan.contacts.empty(); });
    if (has_contacts && !(experiment.measurement.force_error > 0))
        needed.push_back(
            "experiment.toml must state how well the forces of contacts.csv are known: simulated ones are "
            "read "
            "with that error too; add to [measurement] a line such as `force_error = 0.05 # relative`");
    for (std::string& text : needed) text = experiment.name + ": " + text;
    return needed;
}

}  // namespace mcdem::diagnose
