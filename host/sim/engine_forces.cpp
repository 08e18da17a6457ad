// Forces on grains whose motion is prescribed.
#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>

#include "core/container.h"
#include "sim/engine.h"

namespace mcdem::inline sim {

GrainForces Engine::forces_at(int replica, const GrainMotion& motion, double duration) {
    ReplicaRun& now = run(replica);
    if (duration > 0) now.time_step = duration;
    now.shortening = 0;
    now.rebuild = 1;
    now.plate_z = replicas_[replica].plate.start;
    intervals_.assign(replicas_.size(), {});
    intervals_[replica].steps = 1;
    intervals_[replica].plate_z = now.plate_z;
    activate_moving();
    write_motion(replica, motion);
    fields_.status.write(std::vector<int>(static_cast<std::size_t>(layout_.grains()), 0).data());
    upload_intervals();
    find_neighbours();
    if (duration > 0) {
        make_steps();
        ++now.steps_made;
        write_motion(replica, motion);  // the step has moved the grains
    }
    measure();
    return forces(replica, motion.position);
}

/// Sums over all slots, because adhesion acts across gaps.
GrainForces Engine::forces(int replica, const std::vector<Vec3>& position) const {
    Readings read;
    begin_reading(replica, replica, read);
    const auto first = static_cast<std::size_t>(layout_.first_grain[replica]);
    const auto padded = static_cast<std::size_t>(layout_.first_grain[replica + 1]) - first;
    const std::size_t count = padded * static_cast<std::size_t>(build_.slots);
    std::vector<int> status(padded);
    fields_.status.read(status.data(), first * sizeof(int), padded * sizeof(int));
    read.copies.wait();
    const auto force = reals(read.force, 0, 3 * count), overlap = reals(read.overlap, 0, count),
               arm = reals(read.arm, 0, count);
    std::vector<int> partner(count);
    std::memcpy(partner.data(), read.partner.data(), count * sizeof(int));
    const auto& order = layout_.order[replica];
    const Box box = deformed(replicas_[replica].box, run(replica).strain);
    const std::size_t row = static_cast<std::size_t>(build_.lanes) * static_cast<std::size_t>(build_.slots);
    const auto radii = reals(read.motion, 0, reals_of_motion * order.size());
    const auto radius = [&](std::size_t place) { return radii[reals_of_motion * place + 3]; };
    GrainForces sums{std::vector<Vec3>(order.size(), Vec3::Zero()),
                     std::vector<Vec3>(order.size(), Vec3::Zero())};
    for (std::size_t slot = 0; slot < count; ++slot) {
        const std::size_t place = build_.grain_of_slot(slot);
        if (place >= order.size() || partner[slot] == NO_PARTNER) continue;
        const int grain = order[place];
        const double* const along_x = &force[slot / row * 3 * row + slot % row];
        const Vec3 here(along_x[0], along_x[row], along_x[2 * row]);
        sums.force[grain] += here;
        sums.torque[grain] += arm[slot] * direction(replica, box, position, grain, partner[slot]).cross(here);
        const double other = partner[slot] < 0 ? 0 : radius(static_cast<std::size_t>(partner[slot]) - first);
        sums.deepest_overlap = std::max(sums.deepest_overlap, overlap[slot] / (radius(place) + other));
    }
    for (const int bits : status) sums.status |= bits;
    return sums;
}

}  // namespace mcdem::sim
