// Symmetries: rotation, reflection, translation and renumbering of a packing do not change its behaviour;
// models that coincide in a limit give the same results.
#include <algorithm>
#include <functional>
#include <numeric>

#include "core/names.h"
#include "reference/test_scene.h"

namespace mcdem::reference {
namespace {

/// A transformation of coordinates: of points, vectors and axial vectors.
struct Change {
    const char* what;
    std::function<Vec3(const Vec3&)> point, direction, axis;
};

std::vector<Change> changes() {
    const Vec3 middle = Vec3::Constant(0.5);
    const auto about_middle = [middle](const auto& turn) {
        return [middle, turn](const Vec3& x) -> Vec3 { return middle + turn(x - middle); };
    };
    const auto quarter = [](const Vec3& x) -> Vec3 { return {-x.y(), x.x(), x.z()}; };
    const auto permuted = [](const Vec3& x) -> Vec3 { return {x.y(), x.z(), x.x()}; };
    const auto mirrored = [](const Vec3& x) -> Vec3 { return {-x.x(), x.y(), x.z()}; };
    const auto mirrored_axis = [](const Vec3& x) -> Vec3 { return {x.x(), -x.y(), -x.z()}; };
    const auto same = [](const Vec3& x) -> Vec3 { return x; };
    const auto moved = [](const Vec3& x) -> Vec3 { return x + Vec3(0.11, -0.07, 0.23); };
    return {{"a quarter turn about z", about_middle(quarter), quarter, quarter},
            {"axes permuted", about_middle(permuted), permuted, permuted},
            {"a mirror in x", about_middle(mirrored), mirrored, mirrored_axis},
            {"moved", moved, same, same}};
}

std::vector<Vec3> changed(std::vector<Vec3> vectors, const std::function<Vec3(const Vec3&)>& change) {
    for (auto& v : vectors) v = change(v);
    return vectors;
}

std::vector<Vec3> forces_by_pair(const mcdem::ReplicaState& state) {
    std::vector<Vec3> forces;
    for (const auto& contact : state.contacts) forces.push_back(contact.force);
    return forces;
}

// Sums have another order and coordinates are rounded differently; thirty steps of a soft cluster amplify
// such differences by a factor of about ten.
TEST(Symmetry, RotationReflectionAndTranslationOfAClusterChangeNothing) {
    const double allowed = has_double() ? 1e-11 : 1e-3;
    std::vector<Start> starts;
    for (ContactModel model : all_models) {
        Replica replica = test_replica(model);
        replica.contact.friction_law = FrictionLaw::mindlin;
        starts.push_back(irregular_cluster(replica, 5));
    }
    Uniform uniform(6);
    const auto velocity = uniform.vectors(13, 0.1), spin = uniform.vectors(13, 10);
    const auto after = [&](const std::vector<Start>& from, const std::vector<Vec3>& v,
                           const std::vector<Vec3>& w) {
        Batch batch(build(finest()), from);
        for (std::size_t r = 0; r < from.size(); ++r) batch.engine().set_velocities(r, v, w);
        batch.advance(30);
        std::vector<mcdem::ReplicaState> states;
        for (std::size_t r = 0; r < from.size(); ++r) states.push_back(batch.engine().state(r));
        return states;
    };
    const auto original = after(starts, velocity, spin);
    for (const Change& change : changes()) {
        auto turned = starts;
        for (auto& start : turned) start.packing.position = changed(start.packing.position, change.point);
        const auto states = after(turned, changed(velocity, change.direction), changed(spin, change.axis));
        for (std::size_t r = 0; r < starts.size(); ++r) {
            const std::string where = std::string(change.what) + ", " + std::string(name(all_models[r]));
            EXPECT_LT(relative_difference(states[r].position, changed(original[r].position, change.point)),
                      allowed)
                << where;
            EXPECT_LT(
                relative_difference(states[r].velocity, changed(original[r].velocity, change.direction)),
                allowed)
                << where;
            EXPECT_LT(relative_difference(states[r].angular_velocity,
                                          changed(original[r].angular_velocity, change.axis)),
                      allowed)
                << where;
            EXPECT_LT(relative_difference(forces_by_pair(states[r]),
                                          changed(forces_by_pair(original[r]), change.direction)),
                      allowed)
                << where;
        }
    }
}

// In a cubic box all six walls are equivalent: after a rotation the forces on them are exchanged.
TEST(Symmetry, WallsAreEquivalent) {
    Replica replica = test_replica(ContactModel::elastic_sphere);
    replica.grains.excess_density = 0;
    const Start start = caged_cluster(replica, 0.03, 2e-4, 8);
    Start turned = start;
    for (auto& x : turned.packing.position) x = Vec3(x.y(), x.z(), x.x());
    Batch batch(build(finest()), {start, turned});
    const auto results = batch.advance(20);
    std::array<Vec3, 6> expected;
    for (int axis = 0; axis < 3; ++axis)
        for (int end = 0; end < 2; ++end) {
            const Vec3 f = results[0].wall_force[2 * ((axis + 1) % 3) + end];
            expected[2 * axis + end] = {f.y(), f.z(), f.x()};
        }
    EXPECT_LT(relative_difference(wall_forces(results[1].wall_force), wall_forces(expected)),
              has_double() ? 1e-11 : 1e-4);
    EXPECT_GT(expected[0].norm(), 0.01);
}

/// The same grains, renumbered by `order`.
Start renumbered(const Start& start, const std::vector<int>& order) {
    Start other = start;
    for (std::size_t i = 0; i < order.size(); ++i) {
        other.packing.position[order[i]] = start.packing.position[i];
        other.packing.diameter[order[i]] = start.packing.diameter[i];
    }
    return other;
}

std::vector<int> shuffled(int count, unsigned seed) {
    Uniform uniform(seed);
    std::vector<int> order(count);
    std::iota(order.begin(), order.end(), 0);
    for (int i = count - 1; i > 0; --i) std::swap(order[i], order[static_cast<int>(uniform(0, i + 1))]);
    return order;
}

std::vector<Vec3> renumbered(const std::vector<Vec3>& values, const std::vector<int>& order) {
    std::vector<Vec3> other(values.size());
    for (std::size_t i = 0; i < order.size(); ++i) other[order[i]] = values[i];
    return other;
}

// Grains are stored in the order of a space-filling curve, so their numbers do not change any bit if no two
// grains are in the same cell of the curve. Small grains make the cells small.
TEST(Symmetry, RenumberedGrainsGiveTheSameBits) {
    Start start = jittered_lattice(test_replica(ContactModel::mc_dem), 27, 9);
    start.replica.plate.start = start.replica.plate.end = 0.2;
    for (int i = 0; i < 16; ++i) {
        start.packing.position.push_back({0.01 + 0.01 * (i % 4), 0.01 + 0.01 * (i / 4), 0.15});
        start.packing.diameter.push_back(0.008);
    }
    const auto order = shuffled(43, 10);
    const Start other = renumbered(start, order);
    Batch one(build(Precision::single_precision), start), two(build(Precision::single_precision), other);
    one.advance(100);
    two.advance(100);
    const auto a = one.engine().state(0), b = two.engine().state(0);
    EXPECT_TRUE(same_bits(renumbered(a.position, order), b.position));
    EXPECT_TRUE(same_bits(renumbered(a.velocity, order), b.velocity));
    EXPECT_TRUE(same_bits(renumbered(a.angular_velocity, order), b.angular_velocity));
    EXPECT_FALSE(same_bits(a.position, b.position));
    EXPECT_EQ(a.contacts.size(), b.contacts.size());
}

TEST(Symmetry, GammaZeroEqualsIndependentBitForBit) {
    Start zero = caged_cluster(test_replica(ContactModel::mc_dem), 0.03, 2e-4, 11);
    zero.replica.contact.gamma = 0;
    Start independent = zero;
    independent.replica.contact.model = ContactModel::independent;
    Batch batch(build(Precision::single_precision), {zero, independent});
    batch.advance(100);
    EXPECT_TRUE(same_bits(batch.engine().state(0), batch.engine().state(1)));
}

TEST(Symmetry, GammaOneEqualsTheHalfSpaceBitForBit) {
    Start one = caged_cluster(test_replica(ContactModel::mc_dem), 0.03, 2e-4, 12);
    one.replica.contact.gamma = 1;
    Start half_space = one;
    half_space.replica.contact.model = ContactModel::elastic_half_space;
    Start other = one;
    other.replica.contact.gamma = 1.001;
    Batch batch(build(Precision::single_precision), {one, half_space, other});
    batch.advance(50);
    EXPECT_TRUE(same_bits(batch.engine().state(0), batch.engine().state(1)));
    EXPECT_FALSE(same_bits(batch.engine().state(0), batch.engine().state(2)));
}

// At nu = 1/2, with contact points very close to the sphere. They are at R (1 - compression), so
// displacements of the half space are larger by this fraction, and the corrections of the forces differ
// accordingly.
TEST(Symmetry, HalfSpaceNearTheSphereEqualsSphereToSphere) {
    constexpr double compression = 1e-3;
    std::vector<Start> starts;
    for (ContactModel model :
         {ContactModel::elastic_half_space, ContactModel::sphere_to_sphere, ContactModel::independent}) {
        Replica replica = test_replica(model);
        replica.grains.poisson_ratio = 0.5;
        replica.grains.excess_density = 0;
        replica.walls.youngs_modulus = 1e12;
        starts.push_back(caged_cluster(replica, compression, 0, 13));
    }
    Batch batch(build(finest()), starts);
    batch.advance(40);
    std::vector<std::vector<Vec3>> forces;
    for (int r = 0; r < 3; ++r) forces.push_back(forces_by_pair(batch.engine().state(r)));
    const double corrections = relative_difference(forces[1], forces[2]);
    EXPECT_GT(corrections, 0.05);
    EXPECT_LT(relative_difference(forces[0], forces[1]), 3 * compression * corrections);
}

}  // namespace
}  // namespace mcdem::reference
