// Checks contacts against positions, the plate's gauge, the stated threshold and the stiffness.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/container.h"
#include "core/median.h"
#include "experiment/findings.h"

namespace mcdem::inline experiment {
namespace {

constexpr double max_apart = 0.15;      // gap over the mean diameter, as in the contact search of simulations
constexpr double max_pulling = 0.2;     // fraction of the contacts that are not weak
constexpr double gauge_range = 1.5;     // force of plate contacts over that of the gauge, or the inverse
constexpr double clear_sum = 4;         // in multiples of the threshold times the number of plate contacts
constexpr std::size_t min_pairs = 20;   // for a typical force
constexpr double clear_overlap = 0.02;  // over R*
constexpr double hertz_range =
    5;  // force over that of Hertz's law, or the inverse: indicates a wrong modulus or unit, not an effect
constexpr double gap_in_forces = 1.5;  // weakest force over the threshold
constexpr std::size_t many_contacts = 1000;

/// Gap between the surfaces [m].
double gap(const Recording& recording, const Scan& scan, const Contact& contact) {
    const Vec3& centre = at(scan.position, contact.grain);
    const double radius = radius_of(recording, contact.grain);
    if (is_wall(contact.partner))
        return wall_distance(recording.box, wall_of(contact.partner), scan.plate_z, centre) - radius;
    return apart(recording.box, centre, at(scan.position, contact.partner)).norm() - radius -
           radius_of(recording, contact.partner);
}

std::string names(const Recording& recording, const Contact& contact) {
    return is_wall(contact.partner) ? fmt::format("grain {} and {}", contact.grain,
                                                  wall_name(recording.box, wall_of(contact.partner)))
                                    : fmt::format("grains {} and {}", contact.grain, contact.partner);
}

void check_places(const Recording& recording, Findings& findings) {
    Tally distant, off;
    const double diameter = mean_diameter(recording);
    for (const Scan& scan : recording.scans) {
        if (scan.position.empty()) continue;
        for (const Contact& contact : scan.contacts) {
            const double distance = gap(recording, scan, contact);
            if (distance > max_apart * diameter)
                distant.add(scan, "{}, {:.3g} mm", names(recording, contact), 1e3 * distance);
            const double away = apart(recording.box, at(scan.position, contact.grain), contact.point).norm();
            if (away > 1.5 * radius_of(recording, contact.grain))
                off.add(scan, "{}, {:.3g} mm from the centre of grain {}", names(recording, contact),
                        1e3 * away, contact.grain);
        }
    }
    findings.odd(contacts_file, distant,
                 "contacts of grains that do not touch, are grains and frames numbered as in grains.csv? ");
    findings.odd(contacts_file, off, "contact points away from their grain: ");
}

/// Direction in which a contact repels its grain.
Vec3 outward(const Box& box, const Scan& scan, const Contact& contact) {
    const Vec3& centre = at(scan.position, contact.grain);
    if (is_wall(contact.partner)) return -towards_wall(box, wall_of(contact.partner), centre);
    return apart(box, at(scan.position, contact.partner), centre).normalized();
}

void check_signs(const Recording& recording, double force_threshold, Findings& findings) {
    Tally pulls;
    std::size_t all = 0;
    for (const Scan& scan : recording.scans)
        for (const Contact& contact : scan.contacts) {
            if (scan.position.empty() || contact.force.norm() < 3 * force_threshold) continue;
            ++all;
            if (contact.force.dot(outward(recording.box, scan, contact)) < 0)
                pulls.add(scan, "{}, {:.3g} N", names(recording, contact), contact.force.norm());
        }
    if (pulls.count() > max_pulling * static_cast<double>(all))
        findings.odd(contacts_file,
                     "of {} contacts above three thresholds many pull their grain: the force must be that on "
                     "`grain`, by `partner`: {}",
                     all, pulls.text());
}

void check_threshold(const Recording& recording, double force_threshold, Findings& findings) {
    Tally below;
    std::size_t all = 0;
    double weakest = std::numeric_limits<double>::infinity();
    for (const Scan& scan : recording.scans)
        for (const Contact& contact : scan.contacts) {
            const double force = contact.force.norm();
            ++all;
            weakest = std::min(weakest, force);
            if (force < force_threshold)
                below.add(scan, "{}, {:.3g} mN", names(recording, contact), 1e3 * force);
        }
    findings.odd(contacts_file, below,
                 "forces below the stated threshold of {:.3g} mN: ", 1e3 * force_threshold);
    if (force_threshold > 0 && all >= many_contacts && weakest > gap_in_forces * force_threshold)
        findings.odd(
            contacts_file,
            "of {} contacts the weakest has {:.3g} mN: the threshold is higher than the stated {:.3g} mN",
            all, 1e3 * weakest, 1e3 * force_threshold);
}

void check_gauge(const Recording& recording, double force_threshold, Findings& findings) {
    std::vector<double> ratios;
    for (const Scan& scan : recording.scans) {
        double sum = 0, unseen = 0;
        for (const Contact& contact : scan.contacts) {
            if (contact.partner != wall_partner(Wall::plate)) continue;
            sum -= contact.force.z();
            unseen += force_threshold;
        }
        if (unseen > 0 && scan.top_force() > clear_sum * unseen) ratios.push_back(sum / scan.top_force());
    }
    const double ratio = median(ratios);
    if (ratio < 1 / gauge_range || ratio > gauge_range)
        findings.odd(contacts_file,
                     "the contacts with the plate add up to {:.3g} times the top force: are the units or "
                     "signs the same, are contacts left out?",
                     ratio);
}

/// Typical force over that of Hertz's law at the typical overlap, for the stronger half of the contacts at
/// the largest load. There overlaps are significant, and the selection by force is not biased by errors of
/// positions.
double force_over_hertz(const Recording& recording, const Scan& scan, double modulus, double nu) {
    struct Pair {
        double force, overlap, reduced_radius;
    };
    std::vector<Pair> pairs;
    for (const Contact& contact : scan.contacts) {
        if (is_wall(contact.partner)) continue;
        const double a = radius_of(recording, contact.grain), b = radius_of(recording, contact.partner);
        pairs.push_back({contact.force.norm(), -gap(recording, scan, contact), a * b / (a + b)});
    }
    std::ranges::sort(pairs, {}, &Pair::force);
    std::vector<double> forces, overlaps, radii;
    for (std::size_t k = pairs.size() / 2; k < pairs.size(); ++k) {
        forces.push_back(pairs[k].force);
        overlaps.push_back(pairs[k].overlap);
        radii.push_back(pairs[k].reduced_radius);
    }
    const double overlap = median(overlaps);
    if (forces.size() < min_pairs || overlap < clear_overlap * median(radii)) return 1;
    return median(forces) /
           (4.0 / 3 * modulus / (2 * (1 - nu * nu)) * std::sqrt(median(radii)) * std::pow(overlap, 1.5));
}

void check_stiffness(const Experiment& experiment, Findings& findings) {
    const auto modulus = material(experiment, "grains.youngs_modulus");
    const Scan* strongest = nullptr;
    for (const Scan& scan : experiment.recording.scans)
        if (!scan.position.empty() && !scan.contacts.empty() &&
            (!strongest || scan.top_force() > strongest->top_force()))
            strongest = &scan;
    if (!modulus || !strongest) return;
    const double nu = material(experiment, "grains.poisson_ratio").value_or(0.5);
    const double ratio = force_over_hertz(experiment.recording, *strongest, *modulus, nu);
    if (ratio < 1 / hertz_range || ratio > hertz_range)
        findings.odd(contacts_file,
                     "at the highest load forces are {:.3g} times those of Hertz at the measured overlaps: "
                     "are grains.youngs_modulus [Pa], the forces [N] and the diameters [m] in these units?",
                     ratio);
}

}  // namespace

void check_contacts(const Experiment& experiment, Findings& findings) {
    const Recording& recording = experiment.recording;
    const double force_threshold = experiment.measurement.force_threshold;
    check_threshold(recording, force_threshold, findings);
    check_gauge(recording, force_threshold, findings);
    if (recording.diameter.empty()) return;
    check_places(recording, findings);
    check_signs(recording, force_threshold, findings);
    check_stiffness(experiment, findings);
}

}  // namespace mcdem::experiment
