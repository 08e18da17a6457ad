#include "experiment/instrument.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/container.h"
#include "core/parameters.h"
#include "core/random.h"

namespace mcdem::inline experiment {
namespace {

/// All values are unknown; measured at rest.
Scan unknown_scan() {
    Scan scan;
    scan.time = unknown;
    scan.kinetic_energy = scan.elastic_energy = unknown;
    scan.coordination_number = scan.mean_force = scan.packing_fraction = scan.branch_length = unknown;
    scan.settled = true;
    for (Vec3& force : scan.wall_force) force.setConstant(unknown);
    return scan;
}

/// The largest force on the plate in any scan, at least 0 [N].
double highest_top_force(const Recording& recording) {
    double highest = 0;
    for (const Scan& scan : recording.scans) highest = std::max(highest, scan.top_force());
    return highest;
}

class Reading {
public:
    Reading(const Recording& truth, const Instrument& instrument, std::uint64_t seed)
        : instrument_(instrument),
          highest_(highest_top_force(truth)),
          centre_(0.5 * truth.box.size_x, 0.5 * truth.box.size_y, 0),
          grains_(truth.diameter.size()),
          has_times_(has_programme(truth.parameters)),
          position_noise_(seed, Stream::measured_positions),
          force_noise_(seed, Stream::measured_forces) {}

    /// `path`: path length of the plate up to this scan, over that of all cycles. `top_force`: at the load
    /// cell [N].
    Scan read(const Scan& truth, std::size_t frame, double path, double top_force) const {
        Scan scan = unknown_scan();
        scan.frame = static_cast<int>(frame);
        scan.cycle = truth.cycle;
        scan.phase = truth.phase;
        if (has_times_) scan.time = truth.time;
        scan.plate_z = truth.plate_z + instrument_.strain_offset;
        scan.wall_force[static_cast<std::size_t>(Wall::plate)].z() =
            (1 + instrument_.gauge_drift * path) * top_force + instrument_.zero_drift * path * highest_ +
            hysteresis(truth.phase, top_force) + (path > 0 ? friction_of_guide(truth.phase) : 0);
        const auto shift = shifts(frame);
        scan.position.reserve(truth.position.size());
        for (std::size_t i = 0; i < truth.position.size(); ++i)
            scan.position.push_back(stretched(truth.position[i]) + shift[i]);
        scan.contacts.reserve(truth.contacts.size());
        for (const Contact& contact : truth.contacts) add(contact, frame, shift, scan.contacts);
        return scan;
    }

private:
    double hysteresis(Phase phase, double force) const {
        if (phase != Phase::unload || !(highest_ > 0)) return 0;
        return 4 * instrument_.gauge_hysteresis * force * (1 - force / highest_);
    }

    /// Against the motion of the plate [N].
    double friction_of_guide(Phase phase) const {
        return (phase == Phase::load ? 1 : -1) * instrument_.guide_friction * highest_;
    }

    /// Errors of the grains' centres in this frame [m].
    std::vector<Vec3> shifts(std::size_t frame) const {
        std::vector<Vec3> shift(grains_, Vec3::Zero());
        const double error = instrument_.stated.position_error;
        if (error > 0)
            for (std::size_t i = 0; i < grains_; ++i)
                for (int axis = 0; axis < 3; ++axis)
                    shift[i][axis] = error * position_noise_(frame, 3 * i + static_cast<std::size_t>(axis));
        return shift;
    }

    Vec3 stretched(const Vec3& point) const {
        return centre_ + (1 + instrument_.position_bias) * (point - centre_);
    }

    /// The point of a contact has the mean error of its two centres; at a wall, that of the grain.
    void add(const Contact& truth, std::size_t frame, const std::vector<Vec3>& shift,
             std::vector<Contact>& seen) const {
        Contact contact = truth;
        contact.force *= gain(contact, frame) / (1 + instrument_.force_saturation * truth.force.norm());
        if (contact.force.norm() < instrument_.stated.force_threshold + instrument_.threshold_shift) return;
        const Vec3& of_grain = shift[contact.grain];
        contact.point = stretched(truth.point) + of_grain;
        if (!is_wall(contact.partner)) contact.point += 0.5 * (shift[contact.partner] - of_grain);
        contact.overlap = std::numeric_limits<double>::quiet_NaN();
        seen.push_back(contact);
    }

    /// Not negative: errors do not reverse a force.
    double gain(const Contact& contact, std::size_t frame) const {
        double gain = 1 + instrument_.force_bias;
        if (instrument_.stated.force_error > 0) {
            const auto grain = static_cast<std::uint64_t>(contact.grain);
            const auto partner = static_cast<std::uint32_t>(contact.partner);
            gain *= 1 + instrument_.stated.force_error * force_noise_(frame, grain << 32 | partner);
        }
        return std::max(gain, 0.0);
    }

    const Instrument& instrument_;
    double highest_;  ///< top force [N]
    Vec3 centre_;
    std::size_t grains_;
    bool has_times_;  ///< without a programme, displacements are used instead of times
    KeyedNormal position_noise_, force_noise_;
};

/// Path length of the plate up to each scan [m].
std::vector<double> path_of_plate(const Recording& recording) {
    std::vector<double> path;
    double gone = 0, before = recording.plate_start;
    for (const Scan& scan : recording.scans) {
        path.push_back(gone += std::abs(scan.plate_z - before));
        before = scan.plate_z;
    }
    return path;
}

/// Path length of complete cycles [m]; 1 if the plate does not move. A recording may end before its last
/// cycle is complete.
double whole_path(const Recording& recording) {
    double lowest = recording.plate_start;
    for (const Scan& scan : recording.scans) lowest = std::min(lowest, scan.plate_z);
    const double stroke = recording.plate_start - lowest;
    return stroke > 0 ? 2 * stroke * (recording.scans.back().cycle + 1) : 1;
}

/// The top force that is read at scan s [N]: as it was the way `lag` [m] of the plate before, linear between
/// scans. It has caught up where the plate rests.
double late_top_force(const std::vector<Scan>& scans, const std::vector<double>& path, std::size_t s,
                      double lag) {
    const double now = scans[s].top_force();
    if (s == 0 || path[s] == path[s - 1]) return now;
    std::size_t next = s;  // the scan after the point that is read
    while (next > 1 && path[next - 1] >= path[s] - lag) --next;
    const double step = path[next] - path[next - 1];
    const double part = std::min(1.0, (path[next] - path[s] + lag) / step);
    return std::lerp(scans[next].top_force(), scans[next - 1].top_force(), part);
}

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
        length += (scan.position[contact.partner] - scan.position[contact.grain]).norm();
    }
    scan.coordination_number = sides / grains;
    if (contacts > 0) scan.mean_force = force / contacts;
    if (branches > 0) scan.branch_length = length / branches;
}

/// Computes wall forces except the plate's, Z, <f> and <b> of the scans with contacts.
void average_contacts(Recording& recording, double force_threshold) {
    const auto measured = measured_walls(recording);
    for (Scan& scan : recording.scans) {
        if (scan.contacts.empty()) continue;
        sum_wall_forces(scan, measured);
        average(scan, static_cast<double>(recording.diameter.size()), force_threshold);
    }
}

}  // namespace

Recording measured(const Recording& truth, const Instrument& instrument, std::uint64_t seed) {
    Recording recording;
    recording.label = truth.label;
    recording.parameters = truth.parameters;
    recording.failure = truth.failure;
    recording.box = truth.box;
    recording.plate_start = truth.plate_start;
    recording.diameter = truth.diameter;
    const KeyedNormal diameter_noise(seed, Stream::measured_diameters);
    for (std::size_t i = 0; i < recording.diameter.size(); ++i)
        recording.diameter[i] += instrument.stated.diameter_error * diameter_noise(i, 0);
    const Reading reading(truth, instrument, seed);
    recording.scans.reserve(truth.scans.size());
    const std::vector<double> path = path_of_plate(truth);
    const double whole = whole_path(truth);
    for (std::size_t s = 0; s < truth.scans.size(); ++s)
        recording.scans.push_back(reading.read(truth.scans[s], s, path[s] / whole,
                                               late_top_force(truth.scans, path, s, instrument.force_lag)));
    average_contacts(recording, instrument.stated.force_threshold);
    return recording;
}

}  // namespace mcdem::experiment
