#include "sim/compliant_plate.h"

#include <algorithm>
#include <cmath>

namespace mcdem {
namespace {

// A tracker of second order: a packing of stiffness k follows without lag behind a plate of constant speed, and
// errors shrink in every stretch while compliance * k is below 3 (the roots of
// u^2 + catch_up (1 + C k) u + learn (1 + C k) = 0 lie within |1 + u| < 1).
constexpr double catch_up = 0.5;
constexpr double learn = 0.1;

}  // namespace

void CompliantPlate::give_way(Stretch& stretch, double time_step, double farthest) {
    change_ = 0;
    if (compliance_ == 0 || stretch.steps == 0) return;
    const double commanded = stretch.plate_velocity * time_step * stretch.steps;
    const double error = compliance_ * state_.force - state_.given;
    if (commanded != 0) state_.slope = std::clamp(state_.slope + learn * error / commanded, -1.0, 0.0);
    const double most = std::max(farthest, std::abs(commanded));
    const double given = state_.slope * commanded + catch_up * error;
    const double change = std::clamp(given, -most - commanded, most - commanded);
    stretch.plate_z += state_.given;
    stretch.plate_velocity += change / (time_step * stretch.steps);
    change_ = change / stretch.steps;
}

void CompliantPlate::made(const StretchResult& result) {
    state_.given += change_ * result.steps;
    state_.force = result.wall_force[static_cast<int>(Wall::plate)].z();
}

}  // namespace mcdem
