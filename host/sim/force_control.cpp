#include "sim/force_control.h"

#include <algorithm>
#include <cmath>

#include "core/container.h"

namespace mcdem::inline sim {
namespace {

constexpr double tolerance = 1e-3;  ///< of a prescribed force, relative
/// Beyond this relative distance the plate is so slow that not even a rigid packing could exceed the force
/// unnoticed.
constexpr double near = 0.05;
/// Below this relative distance, before a stop, drag removes waves that the controller would mistake for its
/// own effect.
constexpr double quiet = 0.25;
/// Over the elastic stiffness of layers: packings are between a few times stiffer (displaced surfaces, small
/// unloading moves) and several times softer (grains that slide or yield).
constexpr double stiffness_margin = 1.5;
/// The rate follows within a few times `response` times the travel time of a wave through the packing, the
/// force within `approach` times that. The two are separated enough that neither overshoots at any of these
/// stiffnesses.
constexpr double response = 1.5, approach = 14;
/// A velocity that changes its sign and grows, interval after interval, shows that the packing is stiffer
/// than expected, as compressed grains are that yielded and are unloaded. In each such interval the caution
/// grows by the first factor; otherwise it decreases by the second one. It takes effect after five.
constexpr double more_caution = 1.4, less_caution = 0.85;
/// Stiffness of a fast cell over that of its layers, at most: it is strained in all directions at once,
/// strongly compressed, with displaced surfaces.
constexpr double cell_margin = 5;

}  // namespace

ForceControl ForceControl::of_plate(const Replica& replica, const PackingScale& scale) {
    ForceControl control;
    control.inertia_ = scale.mass;
    control.quiet_ = replica.protocol.stop_at_scans ? quiet : near;
    control.layers_ = 1 + replica.plate.start / scale.diameter;
    const double radius = scale.diameter / 2;
    const double area = floor_area(replica.box);
    const double grains = std::clamp(area / (2 * std::sqrt(3.0) * radius * radius), 1.0,
                                     std::max(1.0, static_cast<double>(scale.count)));
    const auto layer = [&](double modulus) {
        return grains * 4 / 3 * modulus * std::sqrt(radius) / (1 - replica.effects.plasticity);
    };
    control.stiffest_layer_ = layer(plane_modulus(stiffest(replica)));
    control.layer_ = layer(scale.modulus);
    return control;
}

/// All layers deform equally, so the stiffness of the whole packing is felt immediately.
ForceControl ForceControl::of_cell(const Replica& replica, const PackingScale& scale) {
    ForceControl control;
    const Box& box = replica.box;
    const double longest = std::max({box.size_x, box.size_y, box.height}), radius = scale.diameter / 2;
    control.inertia_ = scale.mass * longest * longest / (floor_area(box) * box.height);
    control.quiet_ = replica.protocol.stop_at_scans ? quiet : near;
    control.layers_ = 1 / scale.diameter;
    control.rigid_layers_ = control.layers_ / cell_margin;
    const auto layer = [&](double modulus) {
        const double contact =
            4.0 / 3 * modulus / 2 * std::sqrt(radius / 2) / (1 - replica.effects.plasticity);
        return contact / (2 * std::sqrt(3.0) * radius * radius);
    };
    control.stiffest_layer_ = layer(plane_modulus(stiffest(replica)));
    control.layer_ = layer(scale.modulus);
    return control;
}

/// Stiffness of the Hertz contacts of a full layer of grains that do not move.
double ForceControl::layer_stiffness(double force, double layer) {
    return 1.5 * std::cbrt(std::max(0.0, force)) * std::cbrt(layer * layer);
}

double ForceControl::stiffness(const State& state, const Target& target) const {
    return stiffness_margin * layer_stiffness(std::max({target.set, state.force, target.load}), layer_) /
           layers_;
}

/// Travel time of a wave through the packing.
double ForceControl::response_time(const State& state, const Target& target) const {
    return std::sqrt(inertia_ / stiffness(state, target));
}

double ForceControl::interval(const State& state, const Target& target) const {
    return 0.5 * response_time(state, target);
}

double ForceControl::drag(const State& state, const Target& target) const {
    return std::abs(target.set - state.force) <= quiet_ * target.scale ? 1 / response_time(state, target) : 0;
}

double ForceControl::approach_time(const State& state, const Target& target) const {
    return approach * response * response_time(state, target);
}

bool ForceControl::reached(const State& state, const Target& target) {
    return std::abs(state.force - target.set) <= 0.5 * tolerance * target.scale;
}

void ForceControl::observe(State& state, double force, double duration) {
    state.rate = (force - state.force) / duration;
    state.force = force;
}

/// Far from the target, waves in the packing change the force more than the plate does, so only the distance
/// is used. The plate cannot feel more than a layer of the stiffest grains.
double ForceControl::far_speed(const State& state, const Target& target, double duration) const {
    const double left = target.set - state.force;
    const double stiffest =
        layer_stiffness(std::max({state.force, state.force + left / 2, target.load}), stiffest_layer_) /
        rigid_layers_;
    const double blind = duration + std::sqrt(inertia_ / stiffest);
    return 0.5 * std::abs(left) / (stiffest * blind);
}

void ForceControl::steer(State& state, const Target& target, double duration, double max_speed) const {
    const double left = target.set - state.force;
    if (std::abs(left) > near * target.scale) {
        const double speed = std::min(max_speed, far_speed(state, target, duration));
        state.velocity = left > 0 ? -speed : speed;
        return;
    }
    const double follow = response * std::max(duration, response_time(state, target));
    const double lacking = left / (approach * follow) - state.rate;
    const double stiff = std::max(1.0, state.caution) * stiffness(state, target);
    const double change = std::min(0.5, duration / follow) * lacking / stiff;
    const double last = state.velocity;
    state.velocity = std::clamp(last - change, -max_speed, max_speed);
    const bool overshoots = state.velocity * last < 0 && std::abs(state.velocity) >= std::abs(last);
    state.caution =
        std::clamp(state.caution * (overshoots ? more_caution : less_caution), least_caution, most_caution);
}

}  // namespace mcdem::sim
