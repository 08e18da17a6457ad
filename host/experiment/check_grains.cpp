// Checks whether the grains fit into their box, and how they move.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/container.h"
#include "experiment/findings.h"
#include "scene/packing/cell_pairs.h"

namespace mcdem::inline experiment {
namespace {

constexpr double min_fraction = 0.3, max_fraction = 0.95;  // of a packing under load
constexpr double max_overlap = 0.3;  // over the sum of radii; simulations lose their static solution at 0.5
constexpr double max_jump = 0.75;    // over the diameter, in addition to the plate's displacement
constexpr double max_in_wall = 0.5;  // over the radius

void check_volume(const Recording& recording, Findings& findings) {
    double volume = 0;
    for (const double diameter : recording.diameter) volume += std::numbers::pi / 6 * std::pow(diameter, 3);
    const double fraction = volume / (floor_area(recording.box) * recording.scans.front().plate_z);
    if (fraction < min_fraction)
        findings.odd(
            grains_file,
            "the grains fill {:.2g} of the box below the plate: are diameters radii, or grains left out?",
            fraction);
    if (fraction > max_fraction)
        findings.odd(grains_file,
                     "the grains have {:.3g} times the volume of the box below the plate: are diameters too "
                     "large, or is the box too small?",
                     fraction);
}

void check_walls(const Recording& recording, Findings& findings) {
    Tally tally;
    for (const Scan& scan : recording.scans)
        for (int i = 0; i < static_cast<int>(scan.position.size()); ++i)
            for (const Wall wall : walls_of(recording.box)) {
                const double radius = radius_of(recording, i);
                const double inside =
                    radius - wall_distance(recording.box, wall, scan.plate_z, at(scan.position, i));
                if (inside > max_in_wall * radius)
                    tally.add(scan, "grain {} by {:.3g} mm in {}", i, 1e3 * inside,
                              wall_name(recording.box, wall));
            }
    findings.odd(grains_file, tally, "grains reach into a wall by more than half their radius: ");
}

void check_overlaps(const Recording& recording, Findings& findings) {
    Tally tally;
    const double largest = *std::ranges::max_element(recording.diameter);
    for (const Scan& scan : recording.scans) {
        if (scan.position.empty()) continue;
        const CellList cells(scan.position, recording.box, scan.plate_z, largest);
        cells.for_each_pair([&](int i, int j) {
            const double sum = radius_of(recording, i) + radius_of(recording, j);
            const double overlap =
                sum - apart(recording.box, at(scan.position, j), at(scan.position, i)).norm();
            if (overlap > max_overlap * sum)
                tally.add(scan, "grains {} and {} by {:.3g} mm", std::min(i, j), std::max(i, j),
                          1e3 * overlap);
        });
    }
    findings.odd(grains_file, tally, "grains overlap by more than {} of their radii together: ", max_overlap);
}

/// Loose grains move by up to half a diameter; a move to a neighbour's position indicates exchanged numbers.
void check_jumps(const Recording& recording, Findings& findings) {
    Tally tally;
    const Scan* before = nullptr;
    for (const Scan& scan : recording.scans) {
        if (scan.position.empty()) continue;
        for (int i = 0; before && i < static_cast<int>(scan.position.size()); ++i) {
            const double jump = (at(scan.position, i) - at(before->position, i)).norm();
            if (jump > 2 * max_jump * radius_of(recording, i) + std::abs(scan.plate_z - before->plate_z))
                tally.add(scan, "grain {} by {:.3g} mm since frame {}", i, 1e3 * jump, before->frame);
        }
        before = &scan;
    }
    findings.odd(grains_file, tally,
                 "grains jump by most of a diameter from frame to frame, are they numbered consistently? ");
}

}  // namespace

void check_grains(const Experiment& experiment, Findings& findings) {
    const Recording& recording = experiment.recording;
    if (recording.diameter.empty()) return;
    check_volume(recording, findings);
    check_walls(recording, findings);
    check_overlaps(recording, findings);
    check_jumps(recording, findings);
}

}  // namespace mcdem::experiment
