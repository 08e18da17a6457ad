#include "sim/compliant_plate.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/container.h"
#include "sim/device_material.h"

namespace mcdem::inline sim {
namespace {

// The plate follows compliance * force as a second-order tracker, so that it does not lag behind while the
// force changes at a constant rate. Critical damping: the slope is learned with a quarter of the square of
// the catch-up rate.
constexpr double learn = 0.25;

/// Estimated upper limit of the packing's stiffness over that of the plate.
double gain(const Replica& replica) {
    const double block = stiffest(replica).youngs_modulus * replica.box.size_x * replica.box.size_y *
                         floor_share(replica.box) / replica.plate.start;
    return replica.effects.plate_compliance * block / 3;
}

double slowest_wave(const Replica& replica) {
    double slowest = std::numeric_limits<double>::infinity();
    for (const GrainMaterial& material : materials(replica))
        slowest = std::min(slowest, rayleigh_speed(material));
    return slowest;
}

}  // namespace

// A plate that moves at v feels an additional force Z v, with Z = stiffness * travel time of a wave through
// the packing. Following the force faster than that causes oscillations, which are stronger for a more
// compliant plate. In addition, the correction of one interval must not be reversed by the next one: catch_up
// (1 + gain) < 2.
CompliantPlate::CompliantPlate(const Replica& replica)
    : compliance_(replica.effects.plate_compliance),
      follow_time_(replica.plate.start / slowest_wave(replica) * std::max(1.0, gain(replica))),
      max_catch_up_(1 / (1 + gain(replica))) {}

void CompliantPlate::deflect(StepInterval& interval, double time_step, double farthest) {
    change_ = 0;
    if (compliance_ == 0 || interval.steps == 0) return;
    const double duration = time_step * interval.steps;
    const double commanded = interval.plate_velocity * duration;
    const double catch_up = std::min(max_catch_up_, -std::expm1(-duration / follow_time_));
    if (commanded != 0)
        state_.slope =
            std::clamp(state_.slope + learn * catch_up * catch_up * error() / commanded, -1.0, 0.0);
    const double most = std::max(farthest, std::abs(commanded));
    const double change =
        std::clamp(state_.slope * commanded + catch_up * error(), -most - commanded, most - commanded);
    interval.plate_z += state_.given;
    interval.plate_velocity += change / duration;
    change_ = change / interval.steps;
}

void CompliantPlate::on_interval_done(const IntervalResult& result) {
    state_.given += change_ * result.steps;
    state_.force = result.wall_force[static_cast<int>(Wall::plate)].z();
}

bool CompliantPlate::arrived(double farthest) const {
    return std::abs(error()) <= 1e-3 * std::max(std::abs(state_.given), farthest);
}

}  // namespace mcdem::sim
