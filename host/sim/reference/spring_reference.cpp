// Friction and rolling resistance of the reference: springs that turn with their pair and follow its load.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/recording.h"
#include "sim/reference/step_reference.h"

namespace mcdem::reference {
namespace {

/// `v`, perpendicular to the unit vector `before`, after the smallest rotation that takes `before` to `now`,
/// and a rotation by `twist` about `now`.
Vec3 turned(const Vec3& v, const Vec3& before, const Vec3& now, double twist) {
    const Vec3 moved = Eigen::AngleAxisd(twist, now) * (Eigen::Quaterniond::FromTwoVectors(before, now) * v);
    return across(moved, now);
}

/// Adds stiffness times the way to `spring`, the force of a damped spring that yields at `limit`. Returns its
/// force with damping.
Vec3 cut_spring(double limit, double stiffness, double damping, const Vec3& rate, double elapsed,
                Vec3& spring) {
    spring += stiffness * elapsed * rate;
    const Vec3 force = spring + damping * rate;
    if (force.norm() <= limit) return force;
    spring *= limit / force.norm();
    return force * (limit / force.norm());
}

}  // namespace

/// Direction from `a` to `b` before the last step, from the velocities in that step.
Vec3 StepReference::direction_before(const ReferenceContact& contact, const Body& a, const Body& b,
                                     double elapsed) const {
    if (!mcdem::is_wall(contact.partner))
        return (b.position - a.position - elapsed * (b.velocity - a.velocity)).normalized();
    if (b.curvature == 0) return contact.direction;  // a plane wall
    const Vec3 before = a.position - elapsed * a.velocity;
    const double radius = scene_.box.size_x / 2;
    return Vec3(before.x() - radius, before.y() - radius, 0).normalized();
}

/// Turns both springs with the pair; reduces their forces with the contact radius. The tangential spring
/// keeps its displacement, i.e. its force follows the radius both ways, if the scene says so.
void StepReference::carry_springs(const ReferenceContact& contact, const Body& a, const Body& b,
                                  double elapsed, Memory& memory) const {
    const Vec3& e = contact.direction;
    const Vec3 before = direction_before(contact, a, b, elapsed);
    const double twist = elapsed * (a.angular_velocity + b.angular_velocity).dot(e) / 2;
    if (elapsed == 0) {  // a report: the springs have not been turned to the present normal yet
        memory.spring = across(memory.spring, e);
        memory.rolling = across(memory.rolling, e);
    } else {
        memory.spring = turned(memory.spring, before, e, twist);
        memory.rolling = turned(memory.rolling, before, e, twist);
    }
    const double now = contact.contact_radius;
    const double followed = std::clamp(memory.contact_radius, now, (1 + radius_slack_) * now);
    if (memory.contact_radius > 0) {
        const double ratio = followed / memory.contact_radius;
        const bool keeps_displacement =
            scene_.contact.friction_law == mcdem::FrictionLaw::mindlin_displacement;
        memory.spring *= keeps_displacement ? ratio : std::min(1.0, ratio);
        memory.rolling *= std::min(1.0, ratio);
    }
    memory.contact_radius = followed;
}

/// Viscous below `sliding_velocity`. A step removes at most a tenth of m* times the sliding
/// velocity.
Vec3 StepReference::saturated_friction(double limit, const Vec3& sliding, const PairConstants& pair) const {
    const double smooth_speed = std::hypot(sliding.norm(), scene_.contact.sliding_velocity);
    return std::min(limit / smooth_speed, 0.1 * pair.mass / time_step_) * sliding;
}

Vec3 StepReference::mindlin_friction(double limit, const Vec3& sliding, const PairConstants& pair,
                                     double elapsed, Memory& memory) const {
    const double stiffness = 8 * pair.shear_modulus * memory.contact_radius;
    return cut_spring(limit, stiffness, pair.damping * std::sqrt(stiffness * pair.mass), sliding, elapsed,
                      memory.spring);
}

/// Rolling resistance: a damped spring between the rotations across the normal, cut at mu_r R* F_n.
Vec3 StepReference::rolling_couple(double normal, const Body& a, const Body& b, const PairConstants& pair,
                                   double elapsed, Memory& memory) const {
    const auto inertia = [](const Body& body) { return 0.4 * body.mass * body.radius * body.radius; };
    const double reduced = b.radius == 0 ? inertia(a) : 1 / (1 / inertia(a) + 1 / inertia(b));
    const Vec3 e = (b.position - a.position).normalized();
    const Vec3 rolling = across(b.angular_velocity - a.angular_velocity, e);
    const double limit = scene_.effects.rolling_resistance * pair.radius * std::max(normal, 0.0);
    const double stiffness = 8 * pair.shear_modulus * memory.contact_radius * std::pow(pair.radius, 2);
    return cut_spring(limit, stiffness, pair.damping * std::sqrt(stiffness * reduced), rolling, elapsed,
                      memory.rolling);
}

}  // namespace mcdem::reference
