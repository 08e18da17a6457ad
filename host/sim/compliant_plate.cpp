#include "sim/compliant_plate.h"

#include <algorithm>
#include <cmath>

#include "sim/device_replica.h"

namespace mcdem {
namespace {

// The plate goes after compliance * force as a tracker of second order, so that it does not lag behind while the
// plate moves evenly. Critically damped: the slope is learned with a quarter of the square of the catching up.
constexpr double learn = 0.25;

// A plate that moves at v feels Z v more, Z = stiffness * the time that a wave takes through the packing: going after
// the force faster than that rings, and the more so the more compliant it is. Tried on packings of 514 grains up to
// compliance * E * area / height = 27; the packing's own stiffness is about a third of E * area / height.
double follow_time(const Replica& replica) {
    const double height = replica.plate.start;
    const double stiffness = replica.grains.youngs_modulus * replica.box.size_x * replica.box.size_y / height;
    return height / rayleigh_speed(replica.grains) * std::max(1.0, replica.effects.plate_compliance * stiffness / 3);
}

}  // namespace

CompliantPlate::CompliantPlate(const Replica& replica)
    : compliance_(replica.effects.plate_compliance), follow_time_(follow_time(replica)) {}

void CompliantPlate::give_way(Stretch& stretch, double time_step, double farthest) {
    change_ = 0;
    if (compliance_ == 0 || stretch.steps == 0) return;
    const double duration = time_step * stretch.steps;
    const double commanded = stretch.plate_velocity * duration;
    const double error = compliance_ * state_.force - state_.given;
    const double catch_up = -std::expm1(-duration / follow_time_);
    if (commanded != 0)
        state_.slope = std::clamp(state_.slope + learn * catch_up * catch_up * error / commanded, -1.0, 0.0);
    const double most = std::max(farthest, std::abs(commanded));
    const double change = std::clamp(state_.slope * commanded + catch_up * error, -most - commanded, most - commanded);
    stretch.plate_z += state_.given;
    stretch.plate_velocity += change / duration;
    change_ = change / stretch.steps;
}

void CompliantPlate::made(const StretchResult& result) {
    state_.given += change_ * result.steps;
    state_.force = result.wall_force[static_cast<int>(Wall::plate)].z();
}

}  // namespace mcdem
