#include "sim/quasi_static.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/constants.h"
#include "core/container.h"
#include "scene/packing/true_grains.h"
#include "scene/species.h"
#include "sim/device_material.h"
#include "sim/device_replica.h"

namespace mcdem::inline sim {
namespace {

constexpr double min_pressure_over_modulus = 1e-5;

/// A rearrangement takes its own time, and the force falls meanwhile. The grains move faster than the plate
/// drives them: in a homogeneous deformation between the floor and a plate of speed v their kinetic energy is
/// m v^2/6, and apart from rearrangements it was 1.0 to 2.3 times as much in most scans, in them 10 to 100
/// times. Above `max_agitation` times, the plate slows down in proportion.
constexpr double max_agitation = 4, max_slowing = 0.1;

/// Contacts that are hardly damped keep the vibrations that the first touch and changes of speed excite;
/// their amplitude is proportional to the speed. Above a restitution of 0.98 the plate is slower with the
/// root of the damping, at most five times: then forces of one grain between plates vibrate by less than 0.2
/// %.
constexpr double damped_enough = 0.98, slowest_undamped = 0.2;
double slowing_without_damping(const Replica& replica) {
    double most = 0;
    for (std::size_t i = 0; i < std::max<std::size_t>(1, replica.species.size()); ++i)
        for (std::size_t j = 0; j <= i; ++j) most = std::max(most, pair_law(replica, i, j).restitution);
    return std::clamp(std::sqrt(damping_factor(most) / damping_factor(damped_enough)), slowest_undamped, 1.0);
}

double sphere_volume(double diameter) { return std::numbers::pi / 6 * std::pow(diameter, 3); }

/// Of a tilted plate, the lowest edge counts.
double top_of(const Replica& replica, const Packing& packing) {
    double top = 0;
    for (std::size_t i = 0; i < packing.size(); ++i)
        top = std::max(top, packing.position[i].z() + packing.diameter[i] / 2);
    const auto& tilt = replica.effects;
    return top + (std::abs(tilt.plate_tilt_x) * replica.box.size_x +
                  std::abs(tilt.plate_tilt_y) * replica.box.size_y) /
                     2;
}

}  // namespace

PackingScale scale_of(const Replica& replica, const Packing& packing) {
    PackingScale scale;
    const auto all = materials(replica);
    std::vector<double> volume(all.size(), 0.0);
    for (std::size_t i = 0; i < packing.size(); ++i) {
        scale.diameter += packing.diameter[i] / static_cast<double>(packing.size());
        volume[packing.species_of(i)] += sphere_volume(packing.diameter[i]);
    }
    for (std::size_t s = 0; s < all.size(); ++s) {
        if (!is_cell(replica.box)) scale.weight += all[s].excess_density * gravity * volume[s];
        scale.mass += volume[s] * all[s].density;
        scale.volume += volume[s];
    }
    scale.weight = std::max(0.0, scale.weight);
    double compliance = 0;
    for (std::size_t s = 0; s < all.size(); ++s)
        compliance += volume[s] / scale.volume / plane_modulus(all[s]);
    scale.modulus = all.size() == 1 ? plane_modulus(all[0]) : 1 / compliance;
    scale.density = all.size() == 1 ? all[0].density : scale.mass / scale.volume;
    scale.count = packing.size();
    const Packing grains = true_packing(replica, packing);
    scale.reach = list_reach(replica, grains);
    scale.top = top_of(replica, grains);
    return scale;
}

QuasiStatic::QuasiStatic(const Replica& replica, const PackingScale& scale)
    : tolerance_(replica.protocol.rate_tolerance * slowing_without_damping(replica)),
      area_(floor_area(replica.box)),
      density_(scale.density),
      scale_(scale),
      min_pressure_(
          std::max(scale.weight / area_, min_pressure_over_modulus * softest(replica).youngs_modulus)) {}

double QuasiStatic::pressure(double plate_force, double floor_force) const {
    return std::max(0.5 * (std::abs(plate_force) + std::abs(floor_force)) / area_, min_pressure_);
}

double QuasiStatic::pressure(const Mat3& stress) const { return std::max(stress.trace() / 3, min_pressure_); }

double QuasiStatic::rate_error(double speed, double plate_z, double pressure) const {
    return error_per_inertial_number * speed / plate_z * scale_.diameter * std::sqrt(density_ / pressure);
}

double QuasiStatic::speed(double max_speed, double plate_z, double pressure) const {
    if (tolerance_ == 0) return max_speed;
    return std::min(max_speed, tolerance_ / rate_error(1, plate_z, pressure));
}

double QuasiStatic::slowing(double kinetic_energy, double speed) const {
    const double driven = scale_.mass * speed * speed / 6;
    if (tolerance_ == 0 || kinetic_energy <= max_agitation * driven) return 1;
    return std::max(max_agitation * driven / kinetic_energy, max_slowing);
}

double QuasiStatic::unbalanced_force(double kinetic_energy, double drag, double pressure) const {
    const double mass = density_ * sphere_volume(scale_.diameter);
    const double velocity = std::sqrt(2 * kinetic_energy / (mass * static_cast<double>(scale_.count)));
    return mass * drag * velocity / (pressure * scale_.diameter * scale_.diameter);
}

}  // namespace mcdem::sim
