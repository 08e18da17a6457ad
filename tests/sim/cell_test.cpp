// Fully periodic cells that are deformed: closed-form solutions, symmetries, conservation laws.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/container.h"
#include "core/names.h"
#include "core/stress.h"
#include "sim/whole_run.h"

namespace mcdem::reference {
namespace {

using mcdem::Box;
using mcdem::IntervalResult;
using mcdem::Strain;
using std::numbers::pi;

constexpr double radius = 0.01;

/// No friction and no damping.
Replica conservative(ContactModel model) {
    Replica replica = test_replica(model);
    replica.grains = {23.3e3, 0.45, 1000, 0, 0, 1, 0};
    return replica;
}

/// Cells deformed at constant rates.
class Cells {
public:
    explicit Cells(const std::vector<Start>& starts, Precision precision = finest())
        : starts_(starts), batch_(build(precision), starts), strain_(starts.size()) {}

    std::vector<IntervalResult> advance(int steps, const std::vector<Strain>& rates, double drag = 0) {
        std::vector<int> left(starts_.size(), steps);
        std::vector<IntervalResult> last(starts_.size());
        while (std::ranges::any_of(left, [](int n) { return n > 0; })) {
            std::vector<mcdem::StepInterval> intervals;
            for (std::size_t r = 0; r < starts_.size(); ++r) {
                mcdem::StepInterval next{left[r]};
                next.strain = strain_[r];
                next.strain_rate = rates[r];
                next.settle_drag = drag;
                next.steps = std::min(left[r], engine().max_interval(static_cast<int>(r), next));
                intervals.push_back(next);
            }
            const auto results = engine().advance(intervals);
            for (std::size_t r = 0; r < starts_.size(); ++r) {
                if (intervals[r].steps == 0) continue;
                last[r] = results[r];
                EXPECT_EQ(results[r].status, 0);
                if (results[r].status) return last;
                left[r] -= results[r].steps;
                for (std::size_t k = 0; k < 6; ++k)
                    strain_[r][k] += rates[r][k] * results[r].steps * engine().time_step(static_cast<int>(r));
            }
        }
        return last;
    }
    void set_strains(const std::vector<Strain>& strain) { strain_ = strain; }
    const Strain& strain(std::size_t r) const { return strain_[r]; }
    Box now(std::size_t r) const { return deformed(starts_[r].replica.box, strain_[r]); }
    Engine& engine() { return batch_.engine(); }

private:
    std::vector<Start> starts_;
    Batch batch_;
    std::vector<Strain> strain_;
};

std::vector<Start> all_cells(const Replica& like, int side = 4) {
    std::vector<Start> starts;
    for (const ContactModel model : all_models) {
        Replica replica = like;
        replica.contact.model = model;
        replica.contact.friction_law = FrictionLaw::mindlin;
        starts.push_back(cell_lattice(replica, side, 31));
    }
    return starts;
}

std::vector<Strain> alike(std::size_t count, const Strain& strain) {
    return std::vector<Strain>(count, strain);
}

/// Stored positions of grains that are at these places in the deformed cell.
Start placed(Start start, const Strain& strain) {
    for (Vec3& x : start.packing.position)
        x = into_cell(start.replica.box, mcdem::inverse_deformation(strain) * x);
    return start;
}

double largest(const mcdem::Mat3& m) { return m.cwiseAbs().maxCoeff(); }

/// A simple cubic crystal in which only nearest neighbours touch.
constexpr double spacing = 0.0194;
Start crystal(Replica replica, int side) {
    replica.box = {side * spacing, side * spacing, mcdem::ContainerShape::cell, side * spacing};
    replica.plate.start = side * spacing;
    replica.numerics.time_step = 1e-9;
    Start start{replica, {}};
    for (int i = 0; i < side * side * side; ++i) {
        start.packing.position.push_back(spacing * Vec3(i % side, i / side % side, i / (side * side)) +
                                         Vec3(0.001, -0.003, 0.005));
        start.packing.diameter.push_back(2 * radius);
    }
    return start;
}

/// Effective modulus, and Hertz force at an overlap, of the crystal's contacts.
double crystal_modulus() { return 23.3e3 / (1 - 0.45 * 0.45) / 2; }
double hertz(double overlap) {
    return 4.0 / 3 * crystal_modulus() * std::sqrt(radius / 2) * std::pow(overlap, 1.5);
}

// The damping of contacts includes the velocity of the cell's deformation.
TEST(Cell, DeformationIsDampedByContacts) {
    Replica replica = conservative(ContactModel::independent);
    replica.grains.restitution = 0.7;
    const Strain rate{0.3, -0.2, 0.1, 0.5, -0.4, 0.6};
    Cells cells({crystal(replica, 4)});
    const auto result = cells.advance(1, {rate}).front();
    const double log_e = std::log(0.7), beta = -log_e / std::sqrt(log_e * log_e + pi * pi);
    const double overlap = 2 * radius - spacing, mass = 1000 * 4.0 / 3 * pi * std::pow(radius, 3) / 2;
    const double stiffness = 2 * crystal_modulus() * std::sqrt(radius / 2 * overlap);
    for (int axis = 0; axis < 3; ++axis) {
        const double separating = -rate[axis] * spacing;
        const double force =
            hertz(overlap) - 2 * std::sqrt(5.0 / 6) * beta * std::sqrt(stiffness * mass) * separating;
        EXPECT_NEAR(result.stress(axis, axis) / (force / (spacing * spacing)), 1, has_double() ? 1e-6 : 3e-3);
    }
}

// A simple cubic crystal; every contact is along an edge of the deformed lattice.
TEST(Cell, DeformedCrystalHasTheExpectedStress) {
    const double allowed = has_double() ? 1e-6 : 3e-3;
    const Strain strain{0.01, 0.02, -0.005, 0.06, -0.05, 0.04};
    for (const int side : {3, 4, 9}) {
        const Start start = crystal(conservative(ContactModel::independent), side);
        Cells cells({start});
        cells.set_strains({strain});
        const auto result = cells.advance(1, {Strain{}}).front();
        mcdem::Mat3 expected = mcdem::Mat3::Zero();
        for (int axis = 0; axis < 3; ++axis) {
            const Vec3 branch = spacing * mcdem::deformation(strain).col(axis);
            const double overlap = 2 * radius - branch.norm();
            ASSERT_GT(overlap, 0);
            const double force = hertz(overlap);
            expected += force / branch.norm() * branch * branch.transpose();
        }
        expected /= std::pow(spacing, 3) * mcdem::deformation(strain).diagonal().prod();
        EXPECT_LT(largest(result.stress - expected) / largest(expected), allowed) << side;
        mcdem::Scan scan;
        const auto state = cells.engine().state(0);
        scan.strain = strain;
        scan.plate_z = cells.now(0).height;
        scan.position = state.position;
        scan.contacts = state.contacts;
        EXPECT_EQ(state.contacts.size(), 3u * side * side * side);
        EXPECT_LT(largest(packing_stress(start.replica.box, scan) - expected) / largest(expected), allowed);
        const Vec3 top = result.wall_force[static_cast<int>(mcdem::Wall::plate)];
        const double area = cells.now(0).size_x * cells.now(0).size_y;
        EXPECT_LT((top / area - expected.row(2).transpose()).norm() / largest(expected), allowed);
    }
}

TEST(Cell, ConservesMomentumToRounding) {
    Replica replica = test_replica();
    replica.grains.drag = 0;
    const auto starts = all_cells(replica);
    Cells cells(starts);
    const Strain rate{0.3, -0.1, 0.2, 0.5, -0.4, 0.3};
    const std::size_t count = starts[0].packing.size();
    Uniform uniform(3);
    auto velocity = uniform.vectors(count, 0.1);
    const auto momentum = [&](std::size_t r, const std::vector<Vec3>& v) {
        std::pair<Vec3, double> sum{Vec3::Zero(), 0};
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3 one = std::pow(starts[r].packing.diameter[i], 3) * v[i];
            sum = {sum.first + one, sum.second + one.norm()};
        }
        return sum;
    };
    double mass = 0;
    for (const double d : starts[0].packing.diameter) mass += std::pow(d, 3);
    const Vec3 mean = momentum(0, velocity).first / mass;
    for (Vec3& v : velocity) v -= mean;
    for (std::size_t r = 0; r < starts.size(); ++r)
        cells.engine().set_velocities(static_cast<int>(r), velocity, uniform.vectors(count, 10));
    cells.advance(200, alike(starts.size(), rate));
    for (std::size_t r = 0; r < starts.size(); ++r) {
        const auto [after, size] = momentum(r, cells.engine().state(static_cast<int>(r)).velocity);
        EXPECT_LT(after.norm() / size, has_double() ? 1e-13 : 1e-5) << name(all_models[r]);
        EXPECT_GT(std::abs(size - momentum(r, velocity).second) / size, 1e-2) << "nothing has happened";
    }
}

// Grains without contacts move in straight lines, whatever the deformation of the cell.
TEST(Cell, FreeGrainsKeepTheirVelocity) {
    Start start = cell_lattice(conservative(ContactModel::independent), 3, 5);
    start.packing.position.resize(2);
    start.packing.diameter.resize(2);
    start.packing.position[1] += Vec3(0.03, 0.03, 0.03);
    const Strain before{0.05, -0.02, 0.1, 0.3, 0.2, -0.4}, rate{0.9, -0.5, 0.7, 2, -1.5, 1};
    Cells cells({start});
    cells.set_strains({before});
    const std::vector<Vec3> own{{0.01, 0.02, -0.03}, {-0.02, 0.03, 0.01}};
    cells.engine().set_velocities(0, own, {Vec3::Zero(), Vec3::Zero()});
    const double duration = 200 * cells.engine().time_step(0);
    cells.advance(200, {rate});
    const auto state = cells.engine().state(0);
    for (std::size_t i = 0; i < 2; ++i) {
        const Vec3 from = mcdem::deformation(before) * start.packing.position[i];
        const Vec3 velocity = own[i] + mcdem::velocity_gradient(before, rate) * from;
        // First order in the step: positions are computed half a step after velocities.
        EXPECT_LT((state.position[i] - (from + duration * velocity)).norm() / (duration * velocity.norm()),
                  0.01);
        const Vec3 now =
            state.velocity[i] + mcdem::velocity_gradient(cells.strain(0), rate) * state.position[i];
        EXPECT_LT((now - velocity).norm() / own[i].norm(), 0.01);
        EXPECT_GT((state.velocity[i] - own[i]).norm() / own[i].norm(), 0.1) << "the cell has done nothing";
    }
}

struct After {
    mcdem::ReplicaState state;
    IntervalResult result;
};

std::vector<After> after_steps(const std::vector<Start>& starts, const std::vector<Strain>& strain,
                               const std::vector<Strain>& rate) {
    Cells cells(starts);
    cells.set_strains(strain);
    const auto last = cells.advance(30, rate);
    std::vector<After> all;
    for (std::size_t r = 0; r < starts.size(); ++r)
        all.push_back({cells.engine().state(static_cast<int>(r)), last[r]});
    return all;
}

constexpr Strain some_strain{0.02, 0.01, -0.01, 0.05, -0.04, 0.03}, some_rate{0.2, -0.1, 0.1, 0.5, -0.3, 0.4};

TEST(Cell, TranslationByLatticeVectorsChangesNothing) {
    const double allowed = has_double() ? 1e-10 : 3e-3;
    const auto starts = all_cells(test_replica());
    auto moved = starts;
    const Box box = starts[0].replica.box;
    for (Start& start : moved)
        for (std::size_t i = 0; i < start.packing.size(); ++i)
            start.packing.position[i] +=
                Vec3((double(i % 3) - 1) * box.size_x, (double(i % 5) - 2) * box.size_y,
                     (double(i % 4) - 2) * box.height);
    const auto strain = alike(starts.size(), some_strain), rate = alike(starts.size(), some_rate);
    const auto one = after_steps(starts, strain, rate), other = after_steps(moved, strain, rate);
    for (std::size_t r = 0; r < starts.size(); ++r) {
        EXPECT_LT(relative_difference(other[r].state.velocity, one[r].state.velocity), allowed);
        EXPECT_LT(relative_difference(forces_of(other[r].state), forces_of(one[r].state)), allowed);
        EXPECT_GT(largest(one[r].result.stress), 0);
    }
}

// Cyclic permutation: x to y, y to z, z to x.
TEST(Cell, PermutationOfTheAxesChangesNothing) {
    const double allowed = has_double() ? 1e-10 : 3e-3;
    const auto turned = [](const Vec3& x) -> Vec3 { return {x.z(), x.x(), x.y()}; };
    const auto starts = all_cells(test_replica());
    auto other = starts;
    for (Start& start : other)
        for (Vec3& x : start.packing.position) x = turned(x);
    const Strain strain{0.02, 0.01, -0.01, 0.05, 0, 0}, rate{0.2, -0.1, 0.1, 0.5, 0, 0};
    const Strain turned_strain{-0.01, 0.02, 0.01, 0, 0, 0.05}, turned_rate{0.1, 0.2, -0.1, 0, 0, 0.5};
    const auto first = after_steps(starts, alike(starts.size(), strain), alike(starts.size(), rate));
    const auto second =
        after_steps(other, alike(starts.size(), turned_strain), alike(starts.size(), turned_rate));
    for (std::size_t r = 0; r < starts.size(); ++r) {
        auto velocity = first[r].state.velocity, forces = forces_of(first[r].state);
        for (auto* vectors : {&velocity, &forces})
            for (Vec3& v : *vectors) v = turned(v);
        EXPECT_LT(relative_difference(second[r].state.velocity, velocity), allowed);
        EXPECT_LT(relative_difference(forces_of(second[r].state), forces), allowed);
        EXPECT_NEAR(second[r].result.stress(1, 2) / first[r].result.stress(0, 1), 1, 1e3 * allowed);
    }
}

// A shear by whole periods maps the lattice onto itself.
TEST(Cell, FindsNeighboursAtLargeShear) {
    const double allowed = has_double() ? 1e-10 : 3e-3;
    for (const Strain& leaning :
         {Strain{0, 0, 0, 1, 0, 0}, Strain{0, 0, 0, -3, 4, 2}, Strain{0, 0, 0, 5, -5, 5}}) {
        const auto starts = all_cells(test_replica(), 6);
        std::vector<Start> leant;
        for (const Start& start : starts) leant.push_back(placed(start, leaning));
        const auto none = alike(starts.size(), Strain{});
        const auto one = after_steps(starts, none, none),
                   other = after_steps(leant, alike(starts.size(), leaning), none);
        for (std::size_t r = 0; r < starts.size(); ++r) {
            ASSERT_EQ(one[r].state.contacts.size(), other[r].state.contacts.size());
            EXPECT_LT(relative_difference(other[r].state.velocity, one[r].state.velocity), allowed);
            EXPECT_LT(largest(other[r].result.stress - one[r].result.stress) / largest(one[r].result.stress),
                      allowed);
        }
    }
}

/// Kinetic part of the stress: sum of m v v over the volume.
mcdem::Mat3 kinetic_part(const Start& start, const mcdem::ReplicaState& state) {
    mcdem::Mat3 sum = mcdem::Mat3::Zero();
    for (std::size_t i = 0; i < state.velocity.size(); ++i)
        sum += start.replica.grains.density * pi / 6 * std::pow(start.packing.diameter[i], 3) *
               state.velocity[i] * state.velocity[i].transpose();
    return sum;
}

// Stress times strain rate equals the increase of elastic and kinetic energy.
TEST(Cell, StressTimesStrainRateIsTheWork) {
    if (!has_double()) GTEST_SKIP() << "the device has no double precision";
    for (const Strain& rate : {Strain{0.05, 0.05, 0.05, 0, 0, 0}, Strain{0, 0, 0.1, 0, 0, 0},
                               Strain{0, 0, 0, 0.1, 0.05, -0.05}, Strain{0.05, -0.02, 0.05, 0.1, -0.05, 0.1}})
        for (const ContactModel model : {ContactModel::independent, ContactModel::mc_dem}) {
            Replica replica = conservative(model);
            replica.numerics.time_step = 0.02;
            const Start start = cell_lattice(replica, 4, 8);
            Cells cells({start});
            IntervalResult before =
                cells.advance(16000, {Strain{}}, 0.004 / cells.engine().time_step(0)).front();
            EXPECT_LT(before.kinetic_energy / before.elastic_energy, 0.05);
            const double energy = before.elastic_energy + before.kinetic_energy;
            // Stress times volume at the middle of each interval.
            const auto power = [&](const mcdem::Mat3& stress, const mcdem::Mat3& gradient) {
                const Box now = cells.now(0);
                const mcdem::Mat3 whole = stress * now.size_x * now.size_y * now.height +
                                          kinetic_part(start, cells.engine().state(0));
                return -whole.cwiseProduct(gradient.transpose()).sum();
            };
            double work = 0, moved = 0;
            double last = power(before.stress, mcdem::velocity_gradient(cells.strain(0), rate));
            for (int round = 0; round < 800; ++round) {
                const IntervalResult after = cells.advance(5, {rate}).front();
                const double next = power(after.stress, mcdem::velocity_gradient(cells.strain(0), rate));
                const double gain = 0.5 * (last + next) * 5 * cells.engine().time_step(0);
                work += gain;
                moved += std::abs(gain);
                last = next;
                before = after;
            }
            const double stored = before.elastic_energy + before.kinetic_energy - energy;
            EXPECT_NEAR(stored / moved, work / moved, 2e-3) << name(model) << ' ' << rate[0];
            EXPECT_GT(moved / energy, 0.005);
        }
}

}  // namespace
}  // namespace mcdem::reference
