// Missing data, and what they would show.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>

#include "core/container.h"
#include "core/median.h"
#include "experiment/findings.h"

namespace mcdem::inline experiment {
namespace {

constexpr double rest = 0.005;  // fraction of the stroke: beyond it frame 0 is under load
constexpr int min_frames = 4;   // per stroke
constexpr double min_tilt =
    1e-3;  // angle of forces to the line of centres that indicates tangential components

void missing_frames(const Recording& recording, Findings& findings) {
    long of_phase[2] = {0, 0};
    double stroke = 0;
    for (const Scan& scan : recording.scans) {
        ++of_phase[static_cast<int>(scan.phase)];
        stroke = std::max(stroke, recording.displacement(scan));
    }
    if (of_phase[1] == 0)
        findings.missing(
            plate_file,
            "unloading: viscoelasticity, plasticity and friction show in the loop that it closes");
    for (const Phase phase : {Phase::load, Phase::unload})
        if (const long frames = of_phase[static_cast<int>(phase)]; frames > 0 && frames < min_frames)
            findings.missing(plate_file,
                             "frames of {}ing, there are only {}: the displacement at which a gap opens "
                             "cannot be determined",
                             name(phase), frames);
    const Scan& first = recording.scans.front();
    if (recording.displacement(first) > rest * stroke)
        findings.missing(recording.diameter.empty() ? plate_file : grains_file,
                         "the packing at rest before the first stroke: frame 0 is {:.3g} mm below "
                         "plate.start. A simulation that starts there has other contacts from then on, top "
                         "forces differ by some per cent (simulated runs: protocol.scan_at_start)",
                         1e3 * recording.displacement(first));
}

void missing_positions(const Recording& recording, Findings& findings) {
    if (recording.diameter.empty())
        return findings.missing(
            grains_file,
            "diameters and positions: a diagnosis must start from the positions of frame "
            "0, and other simulations start from a generated packing. Without them no "
            "overlap can be assigned to a force, which is needed to distinguish stiffness, "
            "cross-contact effects and adhesion");
    const auto without = [](const Scan& scan) { return scan.position.empty(); };
    const auto scans = std::ranges::count_if(recording.scans, without);
    if (scans > 0)
        findings.missing(grains_file,
                         "positions in {} of {} frames: overlaps and displacements of grains are compared in "
                         "the others only",
                         scans, recording.scans.size());
}

/// Use of contacts with a wall.
std::string_view told_by(Wall wall) {
    switch (wall) {
        case Wall::floor:
            return "the part of the load that reaches the floor: wall friction, buoyancy";
        case Wall::plate:
            return "tilt of the plate, and whether contact forces agree with the plate's own gauge";
        default:
            return "the side force and the friction of the walls";
    }
}

void missing_contacts(const Recording& recording, Findings& findings) {
    bool seen[wall_count] = {};
    long empty = 0;
    for (const Scan& scan : recording.scans) {
        empty += scan.contacts.empty() && scan.top_force() > 0;
        for (const Contact& contact : scan.contacts)
            if (is_wall(contact.partner)) seen[static_cast<int>(wall_of(contact.partner))] = true;
    }
    const auto frames = static_cast<long>(recording.scans.size());
    if (std::ranges::all_of(recording.scans, [](const Scan& scan) { return scan.contacts.empty(); }))
        return findings.missing(
            contacts_file,
            "contact forces: of the packing only the top force is left, on which "
            "stiffness, cross-contact effects and an offset of the plate have similar "
            "effects; friction, adhesion, scatter among the grains, buoyancy and tilt have "
            "little influence on it");
    if (empty > 0)
        findings.missing(contacts_file,
                         "contacts in {} of {} frames under load: forces are compared in the others only",
                         empty, frames);
    for (const Wall wall : walls_of(recording.box))
        if (!seen[static_cast<int>(wall)])
            findings.missing(contacts_file, "contacts with {}: {}", wall_name(recording.box, wall),
                             told_by(wall));
}

double sine(const Vec3& a, const Vec3& b) { return a.cross(b).norm() / (a.norm() * b.norm()); }

/// At walls the normal is known exactly, between grains with the accuracy of the positions.
void missing_tangential(const Experiment& experiment, Findings& findings) {
    const Recording& recording = experiment.recording;
    std::vector<double> at_walls, between_grains;
    for (const Scan& scan : recording.scans)
        for (const Contact& contact : scan.contacts) {
            if (is_wall(contact.partner))
                at_walls.push_back(sine(
                    contact.force, towards_wall(recording.box, wall_of(contact.partner), contact.point)));
            else if (!scan.position.empty())
                between_grains.push_back(
                    sine(contact.force, apart(recording.box, at(scan.position, contact.grain),
                                              at(scan.position, contact.partner))));
        }
    if (median(at_walls) < min_tilt)
        findings.missing(contacts_file, "tangential forces at walls: friction of walls");
    if (between_grains.empty()) return;
    // Median of the angle caused by errors of both ends, with a margin of a fifth.
    const double by_error =
        1.2 * 1.18 * std::numbers::sqrt2 * experiment.measurement.position_error / mean_diameter(recording);
    if (median(between_grains) < std::max(min_tilt, by_error))
        findings.missing(contacts_file,
                         "tangential forces between grains, all point along the line of centres as "
                         "well as that is known: friction, rolling resistance");
}

void missing_settings(const Experiment& experiment, Findings& findings) {
    std::vector<std::string> unknown, exact;
    for (const std::string& key : material_keys())
        if (!experiment.materials.count(key)) unknown.push_back(key);
    // Parameters of a diagnosis (`nuisances` in diagnose/effects.cpp).
    for (const char* key : {"grains.youngs_modulus", "grains.friction", "walls.friction"})
        if (experiment.materials.count(key) && !experiment.uncertainty.count(key)) exact.push_back(key);
    if (!unknown.empty())
        findings.missing(
            settings_file,
            "{}: a diagnosis warns if a stated value is not that of the scene, which it simulates",
            fmt::join(unknown, ", "));
    if (!exact.empty())
        findings.missing(settings_file,
                         "[uncertainty] of {}: how far each may be from the truth says whether a gap is an "
                         "effect or a calibration",
                         fmt::join(exact, ", "));
}

}  // namespace

void find_missing(const Experiment& experiment, Findings& findings) {
    const Recording& recording = experiment.recording;
    missing_frames(recording, findings);
    missing_positions(recording, findings);
    missing_contacts(recording, findings);
    missing_tangential(experiment, findings);
    missing_settings(experiment, findings);
}

}  // namespace mcdem::experiment
