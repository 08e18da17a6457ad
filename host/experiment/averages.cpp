// Quantities computed from measured contacts.
#include <array>

#include "experiment/measurements.h"

namespace mcdem::inline experiment {
namespace {

/// Walls with any measured contacts: on the others, no contacts does not mean no force.
std::array<bool, wall_count> measured_walls(const Recording& recording) {
    std::array<bool, wall_count> measured{};
    for (const Scan& scan : recording.scans)
        for (const Contact& contact : scan.contacts)
            if (is_wall(contact.partner)) measured[static_cast<std::size_t>(wall_of(contact.partner))] = true;
    return measured;
}

void sum_wall_forces(Scan& scan, const std::array<bool, wall_count>& measured) {
    const std::size_t plate = static_cast<std::size_t>(Wall::plate);
    const double top_force = scan.top_force();
    for (std::size_t wall = 0; wall < wall_count; ++wall)
        if (measured[wall]) scan.wall_force[wall].setZero();
    for (const Contact& contact : scan.contacts)
        if (is_wall(contact.partner))
            scan.wall_force[static_cast<std::size_t>(wall_of(contact.partner))] -= contact.force;
    scan.wall_force[plate].z() = top_force;  // the plate's gauge also measures contacts below the threshold
}

void average(Scan& scan, double grains, double force_threshold) {
    double sides = 0, contacts = 0, force = 0, branches = 0, length = 0;
    for (const Contact& contact : scan.contacts) {
        const double magnitude = contact.force.norm();
        if (magnitude < force_threshold) continue;
        sides += is_wall(contact.partner) ? 1 : 2;
        contacts += 1;
        force += magnitude;
        if (is_wall(contact.partner) || scan.position.empty()) continue;
        branches += 1;
        length += (scan.position[static_cast<std::size_t>(contact.partner)] -
                   scan.position[static_cast<std::size_t>(contact.grain)])
                      .norm();
    }
    scan.coordination_number = sides / grains;
    if (contacts > 0) scan.mean_force = force / contacts;
    if (branches > 0) scan.branch_length = length / branches;
}

}  // namespace

void average_contacts(Recording& recording, double force_threshold) {
    const auto measured = measured_walls(recording);
    for (Scan& scan : recording.scans) {
        if (scan.contacts.empty()) continue;
        sum_wall_forces(scan, measured);
        average(scan, static_cast<double>(recording.diameter.size()), force_threshold);
    }
}

}  // namespace mcdem::experiment
