// Compares the force on the plate with the overlaps of the grains below it: frames of the grains that belong
// to other rows of the plate, a wrong plate.start, origin or unit of force.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/median.h"
#include "experiment/findings.h"

namespace mcdem::inline experiment {
namespace {

constexpr double loaded = 0.3, unloaded = 0.02;  // of the maximum top force
constexpr double gap_under_load = 0.1;           // over the diameter: tilt, contacts by surface displacement
constexpr double max_force_ratio = 4;            // to Hertz's law: strong compression, errors of the modulus
constexpr double max_error = 0.02;               // of positions, over the diameter

/// A frame with positions.
struct Frame {
    const Scan* scan;
    double top = 0;    ///< of the highest grain [m]
    double hertz = 0;  ///< force on the plate for a modulus of 1 Pa and independent contacts [N]
};

std::vector<Frame> frames_of(const Recording& recording) {
    std::vector<Frame> frames;
    for (const Scan& scan : recording.scans) {
        if (scan.position.empty()) continue;
        Frame& frame = frames.emplace_back(Frame{&scan});
        for (int i = 0; i < static_cast<int>(scan.position.size()); ++i) {
            const double radius = radius_of(recording, i), top = at(scan.position, i).z() + radius;
            frame.top = std::max(frame.top, top);
            frame.hertz += 4.0 / 3 * std::sqrt(radius) * std::pow(std::max(0.0, top - scan.plate_z), 1.5);
        }
    }
    return frames;
}

double largest_force(const Recording& recording) {
    double largest = 0;
    for (const Scan& scan : recording.scans) largest = std::max(largest, scan.top_force());
    return largest;
}

void check_touch(const Experiment& experiment, const std::vector<Frame>& frames, double largest,
                 Findings& findings) {
    const Recording& recording = experiment.recording;
    const double tolerance =
        gap_under_load * mean_diameter(recording) + 4 * experiment.measurement.position_error;
    Tally apart;
    for (const Frame& frame : frames) {
        const Scan& scan = *frame.scan;
        const double gap = scan.plate_z - frame.top;
        if (scan.top_force() > unloaded * largest && gap > tolerance)
            apart.add(scan, [&] {
                return fmt::format("{:.3g} mm, at a top force of {:.3g} N", 1e3 * gap, scan.top_force());
            });
    }
    findings.odd(plate_file,
                 "the plate carries a force above the highest grain: is plate.start right, and do these "
                 "frames of the grains belong to these rows of the plate? ",
                 apart);
}

void check_force(const Experiment& experiment, const std::vector<Frame>& frames, double largest,
                 Findings& findings) {
    const Recording& recording = experiment.recording;
    const auto modulus = material(experiment, "grains.youngs_modulus");
    if (!modulus || experiment.measurement.position_error > max_error * mean_diameter(recording)) return;
    const double nu = material(experiment, "grains.poisson_ratio").value_or(0.5);
    const double stiffness = *modulus / (1 - nu * nu);
    std::vector<double> ratios;
    Tally pressed;
    for (const Frame& frame : frames) {
        const Scan& scan = *frame.scan;
        const double hertz = stiffness * frame.hertz;
        if (scan.top_force() > loaded * largest && hertz > 0) ratios.push_back(scan.top_force() / hertz);
        if (scan.top_force() < unloaded * largest && hertz > loaded * largest)
            pressed.add(scan, [&] { return fmt::format("{:.3g} N", scan.top_force()); });
    }
    findings.odd(plate_file,
                 "the plate overlaps with grains as under load, but measures hardly any force: are "
                 "plate.start and the height of the grains right? ",
                 pressed);
    if (ratios.empty()) return;
    const double ratio = median(ratios);
    if (ratio > max_force_ratio || ratio < 1 / max_force_ratio)
        findings.odd(
            plate_file,
            fmt::format(
                "the top force is {:.2g} times that of Hertz's law from the overlaps with the plate: are "
                "its unit, plate.start, the height of the grains and their modulus right, and do the "
                "frames of the grains belong to these rows of the plate?",
                ratio));
}

}  // namespace

void check_plate_load(const Experiment& experiment, Findings& findings) {
    if (experiment.recording.diameter.empty()) return;
    const auto frames = frames_of(experiment.recording);
    const double largest = largest_force(experiment.recording);
    check_touch(experiment, frames, largest, findings);
    check_force(experiment, frames, largest, findings);
}

}  // namespace mcdem::experiment
