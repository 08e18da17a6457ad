// Two grains in contact, moved along a prescribed path step by step.
#pragma once
#include "reference/test_scene.h"

namespace mcdem::reference {

class MovedPair {
public:
    static constexpr double radius = 0.01;

    /// Grains of equal size without damping, `overlap` deep along x, and their friction law and effects. They
    /// are in a large cell about `middle`: small coordinates have small rounding errors.
    static Start start(double overlap, double friction, FrictionLaw law, const mcdem::Effects& effects = {},
                       const Vec3& middle = Vec3::Zero()) {
        Replica replica = test_replica(ContactModel::independent);
        replica.grains = {1e6, 0.3, 1000, 0, friction, 1, 0};
        replica.numerics.time_step = 5e-5;  // the grains hardly move in a step by the contact's own force
        replica.contact.friction_law = law;
        replica.effects = effects;
        replica.box = {1, 1, mcdem::ContainerShape::cell};
        replica.box.height = replica.plate.start = 1;
        replica.plate.end = 0;
        const Vec3 half(radius - overlap / 2, 0, 0);
        return {replica, {{middle - half, middle + half}, {2 * radius, 2 * radius}}};
    }
    MovedPair(const KernelBuild& build, const Start& start) : batch_(build, start) {
        wanted_ = places();
        step(wanted_, Vec3::Zero(), Vec3::Zero());  // finds the contact
    }

    /// Moves the grains by `first` and `second` [m] in `steps` steps in which they turn by `turn` and
    /// `other_turn` [rad]. Returns the work of both [J], by the trapezoidal rule.
    double move(const Vec3& first, const Vec3& second, const Vec3& turn, const Vec3& other_turn, int steps) {
        double work = 0;
        for (int s = 0; s < steps; ++s) {
            const Vec3 before = force();
            const auto from = wanted_;
            step({from[0] + first / steps, from[1] + second / steps}, turn / steps, other_turn / steps);
            work += 0.5 * (before + force()).dot(second / steps - first / steps);
        }
        return work;
    }
    double move_second(const Vec3& way, int steps) {
        return move(Vec3::Zero(), way, Vec3::Zero(), Vec3::Zero(), steps);
    }
    /// Turns the pair as one body about its middle, by `angle` about the unit vector `axis`.
    void turn_together(const Vec3& axis, double angle, int steps) {
        const auto from = wanted_;
        const Vec3 middle = (from[0] + from[1]) / 2;
        for (int s = 1; s <= steps; ++s) {
            const Eigen::AngleAxisd turn(angle * s / steps, axis);
            step({middle + turn * (from[0] - middle), middle + turn * (from[1] - middle)},
                 axis * angle / steps, axis * angle / steps);
        }
    }
    /// Force on the first grain [N]; zero without contact.
    Vec3 force() const {
        const auto contacts = batch_.engine().state(0).contacts;
        return contacts.empty() ? Vec3::Zero() : contacts[0].force;
    }
    Vec3 normal() const {
        const auto x = places();
        return (x[1] - x[0]).normalized();
    }
    Vec3 tangential() const {
        const Vec3 f = force(), n = normal();
        return f - f.dot(n) * n;
    }
    mcdem::Engine& engine() { return batch_.engine(); }

private:
    std::vector<Vec3> places() const { return batch_.engine().state(0).position; }
    void step(const std::vector<Vec3>& to, const Vec3& turn, const Vec3& other_turn) {
        const auto now = places();
        const double dt = batch_.engine().time_step(0);
        batch_.engine().set_velocities(0, {(to[0] - now[0]) / dt, (to[1] - now[1]) / dt},
                                       {turn / dt, other_turn / dt});
        batch_.advance(1);
        wanted_ = to;
    }
    mutable Batch batch_;
    std::vector<Vec3> wanted_;
};

}  // namespace mcdem::reference
