// Effect bulge_contacts: a compressed grain whose equator touches side walls, and the contacts of a packing.
#include "reference/test_scene.h"

namespace mcdem::reference::effects_displacement_contacts {
namespace {

constexpr double radius = 0.01;

/// A grain compressed by a tenth of its radius between floor and plate, with side walls at `gap` from its
/// equator.
Start beside_walls(double bulge_contacts, double gap) {
    Replica replica = test_replica(ContactModel::elastic_half_space);
    replica.grains = {1e5, 0.5, 1000, 0, 0, 0.5, 0};
    replica.walls = {1e12, 0.5, 0, 0.5};
    replica.effects.bulge_contacts = bulge_contacts;
    replica.numerics.probe_gap = 0.3;
    replica.box = {2 * (radius + gap), 2 * (radius + gap)};
    replica.plate.start = 2 * 0.9 * radius;
    return {replica, {{{radius + gap, radius + gap, 0.9 * radius}}, {2 * radius}}};
}

/// Force on a side wall over the force on the plate, at each gap.
std::vector<double> side_forces(double bulge_contacts, const std::vector<double>& gaps) {
    std::vector<Start> starts;
    for (double gap : gaps) starts.push_back(beside_walls(bulge_contacts, gap));
    Batch batch(build(finest()), starts);
    std::vector<double> forces;
    for (const auto& result : batch.advance(600, 200)) {
        EXPECT_EQ(result.status, 0);
        forces.push_back(result.wall_force[static_cast<int>(mcdem::Wall::x_max)].x() /
                         result.wall_force[static_cast<int>(mcdem::Wall::plate)].z());
    }
    return forces;
}

std::vector<double> gaps() {
    std::vector<double> all;
    for (int k = -40; k <= 40; ++k) all.push_back(k * 1e-5);
    return all;
}

// If displacements do not count, contact begins at geometric contact with the wall; the larger the part that
// counts, the earlier. Forces increase from zero without a jump.
TEST(ContactsMadeByDisplacement, ContactBeginsEarlierTheMoreDisplacementsCount) {
    std::vector<double> begins;
    for (double part : {0.0, 0.5, 1.0}) {
        const auto forces = side_forces(part, gaps());
        double begin = -1;
        for (std::size_t k = 1; k < forces.size(); ++k) {
            EXPECT_LE(forces[k], forces[k - 1]) << "part " << part << ", gap " << gaps()[k];
            EXPECT_LT(forces[k - 1] - forces[k], 0.02) << "a jump at part " << part << ", gap " << gaps()[k];
            if (forces[k - 1] > 0) begin = gaps()[k];
        }
        begins.push_back(begin);
    }
    EXPECT_NEAR(begins[0], 0, 1.01e-5);
    EXPECT_GT(begins[2], 1e-4);
    EXPECT_NEAR(begins[1], begins[2] / 2, 1.01e-5) << "half of the displacement reaches half as far";
}

// At large geometric overlap all of the displacement counts, whatever the part.
TEST(ContactsMadeByDisplacement, LargeGeometricOverlapsAreUnchanged) {
    const std::vector<double> deep{-4e-4};
    EXPECT_NEAR(side_forces(0, deep).front(), side_forces(1, deep).front(), has_double() ? 1e-12 : 1e-4);
}

TEST(ContactsMadeByDisplacement, WithPartZeroOnlyGeometricContactsRemain) {
    for (double part : {0.0, 1.0}) {
        Replica replica = test_replica(ContactModel::mc_dem);
        replica.effects.bulge_contacts = part;
        Start start = jittered_lattice(replica, 64, 61);
        for (auto& diameter : start.packing.diameter) diameter *= 0.95;
        Batch batch(build(finest()), start);
        batch.advance(100);
        const auto state = batch.engine().state(0);
        int without_overlap = 0, all = 0;
        for (const auto& contact : state.contacts) {
            if (mcdem::is_wall(contact.partner)) continue;
            const double apart = (state.position[contact.partner] - state.position[contact.grain]).norm();
            const auto& diameter = start.packing.diameter;
            without_overlap += apart > (diameter[contact.grain] + diameter[contact.partner]) / 2;
            ++all;
        }
        EXPECT_GT(all, 40);
        if (part == 0)
            EXPECT_EQ(without_overlap, 0);
        else
            EXPECT_GT(without_overlap, 0);
    }
}

}  // namespace
}  // namespace mcdem::reference::effects_displacement_contacts
