#include "sim/quasi_static.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/container.h"

namespace mcdem::inline sim {
namespace {

constexpr double gravity = 9.81;
constexpr double min_pressure_over_modulus = 1e-5;

double sphere_volume(double diameter) { return std::numbers::pi / 6 * std::pow(diameter, 3); }

}  // namespace

PackingScale scale_of(const Replica& replica, const Packing& packing) {
    PackingScale scale;
    double volume = 0;
    for (const double diameter : packing.diameter) {
        scale.diameter += diameter / static_cast<double>(packing.size());
        volume += sphere_volume(diameter);
    }
    if (!is_cell(replica.box)) scale.weight = std::max(0.0, replica.grains.excess_density * gravity * volume);
    scale.volume = volume;
    scale.count = packing.size();
    return scale;
}

QuasiStatic::QuasiStatic(const Replica& replica, const PackingScale& scale)
    : tolerance_(replica.protocol.rate_tolerance),
      area_(floor_area(replica.box)),
      density_(replica.grains.density),
      scale_(scale),
      min_pressure_(
          std::max(scale.weight / area_, min_pressure_over_modulus * replica.grains.youngs_modulus)) {}

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

double QuasiStatic::unbalanced_force(double kinetic_energy, double drag, double pressure) const {
    const double mass = density_ * sphere_volume(scale_.diameter);
    const double velocity = std::sqrt(2 * kinetic_energy / (mass * static_cast<double>(scale_.count)));
    return mass * drag * velocity / (pressure * scale_.diameter * scale_.diameter);
}

}  // namespace mcdem::sim
