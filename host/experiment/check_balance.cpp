// Force balance of grains at rest: contact forces and weight must cancel, except for errors and missing
// contacts of the instrument.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/constants.h"
#include "core/container.h"
#include "core/median.h"
#include "experiment/findings.h"

namespace mcdem::inline experiment {
namespace {

constexpr double near_wall = 1.25;     // in radii; closer centres may touch a wall
constexpr double min_error = 0.02;     // of a force, if none is stated
constexpr double unseen_contacts = 2;  // per grain, each up to the threshold
constexpr double max_unbalanced = 3;   // in multiples of the expected error
constexpr std::size_t min_grains = 5;

struct Load {
    Vec3 sum = Vec3::Zero();  ///< of its contacts [N]
    double squares = 0;       ///< sum of their squares [N2]
    int contacts = 0;
};

std::vector<Load> loads(const Recording& recording, const Scan& scan) {
    std::vector<Load> all(recording.diameter.size());
    const auto add = [&](int grain, const Vec3& force) {
        Load& load = all[grain];
        load.sum += force;
        load.squares += force.squaredNorm();
        ++load.contacts;
    };
    for (const Contact& contact : scan.contacts) {
        add(contact.grain, contact.force);
        if (!is_wall(contact.partner)) add(contact.partner, -contact.force);
    }
    return all;
}

bool is_in_bulk(const Recording& recording, const Scan& scan, int grain) {
    return std::ranges::none_of(walls_of(recording.box), [&](Wall wall) {
        return wall_distance(recording.box, wall, scan.plate_z, at(scan.position, grain)) <
               near_wall * radius_of(recording, grain);
    });
}

/// Unbalanced force on the grains of the bulk, over the root of the sum of squares and over its error.
struct Imbalance {
    std::vector<double> relative, in_errors;
};

Imbalance imbalance(const Experiment& experiment, const Scan& scan) {
    const Recording& recording = experiment.recording;
    const double specific_weight = gravity * material(experiment, "grains.excess_density").value_or(0);
    const double force_error = std::max(experiment.measurement.force_error, min_error);
    const double unseen = unseen_contacts * std::pow(experiment.measurement.force_threshold, 2);
    const auto all = loads(recording, scan);
    Imbalance found;
    for (int i = 0; i < static_cast<int>(all.size()); ++i) {
        const Load& load = all[i];
        if (load.contacts < 2 || !is_in_bulk(recording, scan, i)) continue;
        const double volume = std::numbers::pi / 6 * std::pow(2 * radius_of(recording, i), 3);
        const double rest = (load.sum - Vec3(0, 0, specific_weight * volume)).norm();
        found.relative.push_back(rest / std::sqrt(load.squares));
        found.in_errors.push_back(rest / std::sqrt(force_error * force_error * load.squares + unseen));
    }
    return found;
}

}  // namespace

void check_balance(const Experiment& experiment, Findings& findings) {
    const Recording& recording = experiment.recording;
    Tally unbalanced;
    std::vector<double> typical;
    for (const Scan& scan : recording.scans) {
        if (scan.position.empty() || scan.contacts.empty()) continue;
        const Imbalance found = imbalance(experiment, scan);
        if (found.relative.size() < min_grains) continue;
        typical.push_back(median(found.relative));
        if (const double errors = median(found.in_errors); errors > max_unbalanced)
            unbalanced.add(scan, "{:.2g} times what the errors explain, {:.0f} % of the forces", errors,
                           100 * typical.back());
    }
    if (!typical.empty())
        findings.note(contacts_file, "of the forces on a grain in the bulk, {:.2g} % do not cancel (median)",
                      100 * median(typical));
    findings.odd(
        contacts_file, unbalanced,
        "forces on the grains do not cancel, was the packing at rest, are contacts left out? Frames: ");
}

}  // namespace mcdem::experiment
