// One grain between floor and plate, compressed equally on both sides by prescribed motion: force against
// overlap of a single contact, without motion of the grain.
#pragma once
#include <cmath>

#include "reference/test_scene.h"

namespace mcdem::reference {

class SqueezedGrain {
public:
    static constexpr double radius = 0.01, youngs_modulus = 1e5, poisson_ratio = 0.3;
    static constexpr double wall_modulus = 1e13;  ///< almost rigid
    static constexpr double modulus =
        1 / ((1 - poisson_ratio * poisson_ratio) * (1 / youngs_modulus + 1 / wall_modulus));

    SqueezedGrain(const mcdem::Effects& effects, double overlap)
        : batch_(build(finest()), start(effects, overlap)), plate_(2 * (radius - overlap)) {}

    /// One step in which the overlap changes by `change` [m]. Returns the upward force on the plate at its
    /// end [N].
    double squeeze(double change) {
        const double dt = time_step(), velocity = -2 * change / dt;
        batch_.engine().set_velocities(0, {{0, 0, velocity / 2}}, {Vec3::Zero()});
        const auto result = batch_.engine().advance({{1, plate_, velocity, 0}}).front();
        EXPECT_EQ(result.status, 0);
        plate_ -= 2 * change;
        energy_ = result.elastic_energy;
        return force_ = result.wall_force[static_cast<int>(mcdem::Wall::plate)].z();
    }
    struct Point {
        double overlap, force, energy;  ///< at the end of a step; the energy of both contacts
        double work;                    ///< of both contacts, since the start of the path [J]
    };
    /// Changes the overlap by `change` [m] in equal steps. Work by the trapezoidal rule.
    std::vector<Point> path(double change, int steps) {
        std::vector<Point> points;
        double work = 0;
        for (int step = 0; step < steps; ++step) {
            const double before = force_;
            work += (before + squeeze(change / steps)) * change / steps;
            points.push_back({overlap(), force_, energy_, work});
        }
        return points;
    }
    double overlap() const { return radius - plate_ / 2; }
    double time_step() const { return batch_.engine().time_step(0); }
    /// 4/3 E* sqrt(R) delta^(3/2)
    static double hertz(double overlap) {
        return overlap > 0 ? 4.0 / 3 * modulus * std::sqrt(radius) * std::pow(overlap, 1.5) : 0;
    }
    /// Relative rounding error of forces: coordinates are rounded to 1e-9 of the overlap, in float to 1e-5.
    static double rounding() { return has_double() ? 1e-9 : 1e-3; }

private:
    static Start start(const mcdem::Effects& effects, double overlap) {
        Replica replica = test_replica(ContactModel::independent);
        replica.grains = {youngs_modulus, poisson_ratio, 1000, 0, 0, 1, 0};
        replica.walls = {wall_modulus, poisson_ratio, 0, 1};
        replica.effects = effects;
        replica.numerics.time_step = 0.02;
        replica.box = {6 * radius, 6 * radius};
        replica.plate.start = 2 * (radius - overlap);
        return {replica, {{{3 * radius, 3 * radius, radius - overlap}}, {2 * radius}}};
    }
    mutable Batch batch_;
    double plate_;
    double force_ = 0, energy_ = 0;
};

}  // namespace mcdem::reference
