// What holds in every replica that comes to its end, whatever the scene: all numbers are finite, forces
// balance where the packing has settled, and no overlap exceeds the scene's limit. Each law has its own
// function.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/constants.h"
#include "core/container.h"
#include "core/recording.h"
#include "scene/packing/true_grains.h"
#include "scene/species.h"

namespace mcdem {

inline void expect_numbers(const Scan& scan) {
    for (const Vec3& position : scan.position) EXPECT_TRUE(position.allFinite());
    for (const Vec3& rotation : scan.rotation) EXPECT_TRUE(rotation.allFinite());
    for (const Vec3& force : scan.wall_force) EXPECT_TRUE(force.allFinite());
    for (const Contact& contact : scan.contacts)
        EXPECT_TRUE(contact.force.allFinite() && contact.point.allFinite() && contact.overlap > 0);
    EXPECT_TRUE(std::isfinite(scan.kinetic_energy) && scan.kinetic_energy >= 0);
    for (const double number : {scan.time, scan.plate_z, scan.elastic_energy, scan.coordination_number,
                                scan.max_overlap, scan.wall_work, scan.weight_work, scan.damping_loss,
                                scan.friction_loss, scan.drag_loss, scan.energy_error})
        EXPECT_TRUE(std::isfinite(number));
    EXPECT_TRUE(scan.stress.allFinite());
}

/// Downward force of gravity on all grains, less buoyancy [N].
inline double weight_of(const Replica& replica, const Packing& grains) {
    const auto all = materials(replica);
    double weight = 0;
    for (std::size_t i = 0; i < grains.size(); ++i)
        weight += all[grains.species_of(i)].excess_density * gravity * std::numbers::pi / 6 *
                  std::pow(grains.diameter[i], 3);
    return weight;
}

/// A scan is settled if the root mean square of the net forces on grains, computed from their velocities, is
/// at most protocol.settle_unbalanced_force times the pressure on a grain's cross-section d^2. The forces on
/// all walls and the weight then differ by at most that times the number of grains, and by the rounding of
/// the forces.
inline void expect_balance_at_rest(const Replica& replica, const Packing& grains, const Scan& scan,
                                   double rounding) {
    if (!scan.settled || is_cell(replica.box)) return;
    Vec3 sum(0, 0, weight_of(replica, grains));
    double size = std::abs(sum.z());
    for (const Vec3& force : scan.wall_force) {
        sum += force;
        size += force.norm();
    }
    for (const Contact& contact : scan.contacts) size += contact.force.norm();
    double diameter = 0;
    for (const double d : grains.diameter) diameter = std::max(diameter, d);
    const double load =
        0.5 * (std::abs(scan.top_force()) + scan.wall_force[static_cast<int>(Wall::floor)].norm());
    const double least = 1e-5 * replica.grains.youngs_modulus;  // QuasiStatic::pressure
    const double pressure =
        std::max(load, std::abs(weight_of(replica, grains))) / floor_area(replica.box) + least;
    const double allowed = replica.protocol.settle_unbalanced_force * pressure * diameter * diameter *
                               static_cast<double>(grains.size()) +
                           rounding * size;
    EXPECT_LE(sum.norm(), allowed) << "frame " << scan.frame
                                   << ": walls and weight are not in balance: " << sum.transpose();
}

/// Corrected overlaps over the sum of radii, times the ratio of the radii; over the radius at a wall.
inline void expect_overlaps_within_limit(const Replica& replica, const Packing& grains, const Scan& scan,
                                         double rounding) {
    for (const Contact& contact : scan.contacts) {
        const auto radius = [&](int grain) { return grains.diameter[static_cast<std::size_t>(grain)] / 2; };
        const double one = radius(contact.grain),
                     other = is_wall(contact.partner) ? 0 : radius(contact.partner);
        const double ratio = is_wall(contact.partner) ? 1 : std::min(one, other) / std::max(one, other);
        EXPECT_LE(contact.overlap, (replica.numerics.overlap_limit + rounding) * (one + other) * ratio)
            << "frame " << scan.frame;
    }
}

/// Work minus the change of stored energy never falls. Where the stored energy is no potential
/// (viscoelasticity, plasticity, contacts that do not count) nothing is known; in the models of the half
/// space, with stiffening and with attraction it is an approximation.
inline void expect_dissipation_grows(const Replica& replica, const Recording& recording) {
    const Effects& e = replica.effects;
    if (e.viscoelasticity > 0 || e.plasticity > 0 || e.adhesion > 0 || e.cohesion > 0 ||
        e.bulge_contacts != 1)
        return;
    const ContactModel model = replica.contact.model;
    const bool rough =
        model == ContactModel::mc_dem || model == ContactModel::elastic_half_space || e.stiffening != 0;
    double most = -HUGE_VAL, stored = 0;
    for (const Scan& scan : recording.scans) {
        const double dissipated = scan.damping_loss + scan.friction_loss + scan.drag_loss - scan.energy_error;
        stored = std::max(stored, scan.elastic_energy + scan.kinetic_energy);
        most = std::max(most, dissipated);
        // Rounding of positions is 1e-9 E R^3 a grain (sim/energy_budget.cpp).
        double least = 0;
        for (const double d : recording.diameter)
            least += 1e-9 * replica.grains.youngs_modulus * std::pow(d / 2, 3);
        EXPECT_LE(most - dissipated, (rough ? 0.3 : 0.01) * std::max(stored, 2 * least))
            << "frame " << scan.frame << ": the time step creates energy";
    }
}

/// `stated`: the packing at the start. A replica that stopped tells why, and its last scans may be wrong.
inline void expect_lawful(const Replica& replica, const Packing& stated, const Recording& recording,
                          Precision precision) {
    EXPECT_TRUE(recording.failure || !recording.scans.empty());
    for (const Scan& scan : recording.scans) expect_numbers(scan);
    if (recording.failure) return;
    const double rounding = precision == Precision::double_precision ? 1e-12 : 1e-5;
    const Packing grains = true_packing(replica, stated);
    expect_dissipation_grows(replica, recording);
    for (const Scan& scan : recording.scans) {
        expect_balance_at_rest(replica, grains, scan, rounding);
        expect_overlaps_within_limit(replica, grains, scan, rounding);
    }
}

}  // namespace mcdem
