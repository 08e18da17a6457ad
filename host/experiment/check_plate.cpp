// Checks the motion of the plate, its gauge, and the stated errors of measurement.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/median.h"
#include "experiment/findings.h"
#include "experiment/measurements.h"
#include "scene/programme/programme_text.h"

namespace mcdem::inline experiment {
namespace {

constexpr double clear_load = 10;   // over the threshold of a contact
constexpr double max_noise = 0.01;  // of plate positions, over the stroke
constexpr double falls = 0.5;       // ratio of the force at the end of loading to the largest force before

/// Whether a frame was taken during a hold, in which the plate may move in both directions.
std::vector<bool> held_frames(const Recording& recording) {
    std::vector<bool> held(recording.scans.size(), false);
    const auto places = scan_places(programme_of(recording.parameters), {recording.plate_start, 0});
    for (std::size_t k = 0; k < places.size() && k + 1 < held.size(); ++k) held[k + 1] = places[k].held;
    return held;
}

void check_course(const Recording& recording, Findings& findings) {
    Tally wrong_way, unload_first, left_out;
    const auto [lowest, highest] = std::ranges::minmax_element(recording.scans, {}, &Scan::plate_z);
    const double noise = max_noise * (highest->plate_z - lowest->plate_z);
    const std::vector<bool> held = held_frames(recording);
    for (std::size_t s = 0; s < recording.scans.size(); ++s) {
        const Scan& scan = recording.scans[s];
        const Scan* before = s > 0 ? &recording.scans[s - 1] : nullptr;
        const bool begins = !before || before->cycle != scan.cycle;
        if (scan.cycle > (before ? before->cycle + 1 : 0))
            left_out.add(scan, "cycle {} follows {}", scan.cycle, before ? before->cycle : -1);
        if (begins ? scan.phase == Phase::unload
                   : before->phase == Phase::unload && scan.phase == Phase::load)
            unload_first.add(scan, "{} of cycle {}", name(scan.phase), scan.cycle);
        if (begins || before->phase != scan.phase || held[s]) continue;
        const double down = before->plate_z - scan.plate_z;
        if ((scan.phase == Phase::load ? down : -down) < -noise)
            wrong_way.add(scan, "{:.6g} m after {:.6g} m in phase {}", scan.plate_z, before->plate_z,
                          name(scan.phase));
    }
    findings.odd(plate_file, wrong_way, "the plate goes against its phase: ");
    findings.odd(plate_file, unload_first, "a cycle is one loading and then one unloading: ");
    findings.odd(plate_file, left_out, "cycles are left out: ");
}

void check_start(const Recording& recording, Findings& findings) {
    const auto highest = std::ranges::max_element(recording.scans, {}, &Scan::plate_z);
    const auto lowest = std::ranges::min_element(recording.scans, {}, &Scan::plate_z);
    const double stroke = highest->plate_z - lowest->plate_z;
    if (highest->plate_z > recording.plate_start + 1e-3 * stroke)
        findings.odd(settings_file, "plate.start, {:.6g} m, is below the plate of frame {}, {:.6g} m",
                     recording.plate_start, highest->frame, highest->plate_z);
    else if (recording.plate_start > highest->plate_z + std::max(stroke, 0.01 * highest->plate_z))
        findings.odd(settings_file,
                     "plate.start, {:.6g} m, is more than the whole stroke above the plate's highest "
                     "position, {:.6g} m",
                     recording.plate_start, highest->plate_z);
}

void check_gauge(const Experiment& experiment, Findings& findings) {
    const Recording& recording = experiment.recording;
    Tally pulls;
    double largest = 0, last = 0;
    for (const Scan& scan : recording.scans) {
        if (scan.top_force() < 0) pulls.add(scan, "{:.3g} N", scan.top_force());
        if (scan.phase != Phase::load || scan.cycle != recording.scans.front().cycle) continue;
        largest = std::max(largest, scan.top_force());
        last = scan.top_force();
    }
    findings.odd(plate_file, pulls, "the top force is negative, though the grains press the plate up: ");
    if (last < falls * largest && largest > clear_load * experiment.measurement.force_threshold)
        findings.odd(plate_file, "the top force falls before loading ends, from {:.3g} to {:.3g} N", largest,
                     last);
}

// The force on the plate and the overlaps of the grains below it: frames of the grains that belong to other
// rows of the plate, a wrong plate.start, origin or unit of force.
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
            apart.add(scan, "{:.3g} mm, at a top force of {:.3g} N", 1e3 * gap, scan.top_force());
    }
    findings.odd(plate_file, apart,
                 "the plate carries a force above the highest grain: is plate.start right, and do these "
                 "frames of the grains belong to these rows of the plate? ");
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
            pressed.add(scan, "{:.3g} N", scan.top_force());
    }
    findings.odd(plate_file, pressed,
                 "the plate overlaps with grains as under load, but measures hardly any force: are "
                 "plate.start and the height of the grains right? ");
    if (ratios.empty()) return;
    const double ratio = median(ratios);
    if (ratio > max_force_ratio || ratio < 1 / max_force_ratio)
        findings.odd(plate_file,
                     "the top force is {:.2g} times that of Hertz's law from the overlaps with the plate: "
                     "are its unit, plate.start, the height of the grains and their modulus right, and do "
                     "the frames of the grains belong to these rows of the plate?",
                     ratio);
}

}  // namespace

void check_plate(const Experiment& experiment, Findings& findings) {
    check_course(experiment.recording, findings);
    check_start(experiment.recording, findings);
    check_gauge(experiment, findings);
}

void check_plate_load(const Experiment& experiment, Findings& findings) {
    if (experiment.recording.diameter.empty()) return;
    const auto frames = frames_of(experiment.recording);
    const double largest = highest_top_force(experiment.recording);
    check_touch(experiment, frames, largest, findings);
    check_force(experiment, frames, largest, findings);
}

void check_errors(const Experiment& experiment, Findings& findings) {
    const Measurement& errors = experiment.measurement;
    const bool has_contacts = std::ranges::any_of(experiment.recording.scans,
                                                  [](const Scan& scan) { return !scan.contacts.empty(); });
    std::vector<std::string_view> zero;
    if (!experiment.recording.diameter.empty()) {
        if (errors.position_error == 0) zero.push_back("position_error");
        if (errors.diameter_error == 0) zero.push_back("diameter_error");
    }
    if (has_contacts && errors.force_error == 0) zero.push_back("force_error");
    if (has_contacts && errors.force_threshold == 0) zero.push_back("force_threshold");
    if (!zero.empty())
        findings.odd(settings_file, "{} {} zero: noise that is not stated is taken for a gap",
                     fmt::join(zero, ", "), zero.size() == 1 ? "is" : "are");
    if (experiment.recording.diameter.empty()) return;
    const double part =
        std::max(errors.position_error, errors.diameter_error) / mean_diameter(experiment.recording);
    if (part > 0.05)
        findings.odd(settings_file,
                     "positions or diameters are known to {:.2g} of a diameter only: overlaps are not larger",
                     part);
}

}  // namespace mcdem::experiment
