#include "experiment/instrument.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "scene/random.h"

namespace mcdem::test::instrument {
namespace {

constexpr int grains = 400, scans = 5;

/// A packing that is not in equilibrium but has everything that a simulation records.
Recording truth() {
    Recording recording;
    recording.label = "true";
    recording.box = {0.2, 0.1};
    recording.plate_start = 0.19;
    Random random(5, Stream::positions);
    for (int i = 0; i < grains; ++i) recording.diameter.push_back(random.uniform(0.018, 0.022));
    for (int s = 0; s < scans; ++s) {
        Scan scan;
        scan.frame = s;
        scan.cycle = s / 4;
        scan.phase = s % 2 ? Phase::unload : Phase::load;
        scan.plate_z = 0.19 - 0.01 * s;
        scan.wall_force[static_cast<int>(Wall::plate)] = Vec3(0.1, 0.2, 3.0 * s);
        scan.packing_fraction = 0.6;
        for (int i = 0; i < grains; ++i)
            scan.position.emplace_back(random.uniform(0.01, 0.19), random.uniform(0.01, 0.09),
                                       random.uniform(0.01, 0.14));
        const auto add = [&](int grain, int partner) {
            scan.contacts.push_back({grain, partner, scan.position[static_cast<std::size_t>(grain)],
                                     Vec3(random.normal(), random.normal(), random.normal()) * 0.1, 1e-3});
        };
        if (s > 0)
            for (int i = 0; i < grains; ++i) {
                for (int next = 1; next < 4; ++next)
                    if (i + next < grains) add(i, i + next);
                add(i, wall_partner(static_cast<Wall>(i % 6)));
            }
        recording.scans.push_back(scan);
    }
    return recording;
}

const Instrument noisy{{1e-4, 5e-5, 0.05, 0.02}, 0.03, -0.01, 0.002, 1e-4};

TEST(measured, is_exact_with_a_perfect_instrument) {
    const Recording real = truth(), seen = measured(real, {}, 1);
    EXPECT_EQ(seen.label, real.label);
    EXPECT_EQ(seen.diameter, real.diameter);
    for (int s = 0; s < scans; ++s) {
        const Scan &p = real.scans[s], &q = seen.scans[s];
        EXPECT_EQ(q.plate_z, p.plate_z);
        EXPECT_EQ(q.top_force(), p.top_force());
        for (int i = 0; i < grains;
             ++i)  // 1 ulp: positions are scaled by a factor of 1 about the middle of the floor
            EXPECT_LT((p.position[i] - q.position[i]).norm(), 1e-15);
        ASSERT_EQ(p.contacts.size(), q.contacts.size());
        Vec3 on_floor = Vec3::Zero();
        for (std::size_t c = 0; c < p.contacts.size(); ++c) {
            EXPECT_EQ(p.contacts[c].force, q.contacts[c].force);
            if (p.contacts[c].partner == wall_partner(Wall::floor)) on_floor -= p.contacts[c].force;
        }
        if (s > 0) {
            EXPECT_EQ(q.wall_force[static_cast<int>(Wall::floor)], on_floor);
        }
    }
}

struct Moments {
    double count = 0, sum = 0, squares = 0;
    void add(double x) { ++count, sum += x, squares += x * x; }
    double mean() const { return sum / count; }
    double sd() const { return std::sqrt(squares / count - mean() * mean()); }
};

/// Mean 0 and the given standard deviation, within 4.5 sigma for this many numbers.
void expect_noise(const Moments& moments, double sd) {
    EXPECT_NEAR(moments.mean(), 0, 4.5 * sd / std::sqrt(moments.count));
    EXPECT_NEAR(moments.sd(), sd, 4.5 * sd / std::sqrt(2 * moments.count));
}

TEST(measured, noise_has_the_stated_size_and_is_uncorrelated) {
    const Recording real = truth(), seen = measured(real, {{2e-4, 1e-4, 0.05, 0}, 0, 0, 0, 0}, 3);
    Moments diameter, coordinate, between_scans, between_axes, size, between_partners, between_forces;
    const auto shift = [&](int s, int i) {
        return Vec3(seen.scans[s].position[i] - real.scans[s].position[i]);
    };
    const auto gain = [&](int s, std::size_t c) {
        const Vec3& force = real.scans[s].contacts[c].force;
        return seen.scans[s].contacts[c].force.dot(force) / force.squaredNorm() - 1;
    };
    for (int i = 0; i < grains; ++i) diameter.add(seen.diameter[i] - real.diameter[i]);
    for (int s = 0; s < scans; ++s)
        for (int i = 0; i < grains; ++i) {
            for (int axis = 0; axis < 3; ++axis) coordinate.add(shift(s, i)[axis]);
            between_axes.add(shift(s, i).x() * shift(s, i).y());
            if (s > 0) between_scans.add(shift(s, i).x() * shift(s - 1, i).x());
        }
    for (int s = 1; s < scans; ++s)
        for (std::size_t c = 0; c < seen.scans[s].contacts.size(); ++c) {
            const Contact &p = real.scans[s].contacts[c], &q = seen.scans[s].contacts[c];
            EXPECT_LT(p.force.cross(q.force).norm(), 1e-15);  // forces of 0.1 N: the same direction
            size.add(gain(s, c));
            if (c > 0 && p.grain == real.scans[s].contacts[c - 1].grain)
                between_partners.add(gain(s, c) * gain(s, c - 1));
            if (s > 1) between_forces.add(gain(s, c) * gain(s - 1, c));
            if (!is_wall(p.partner)) {
                const Vec3 mean = 0.5 * (shift(s, p.grain) + shift(s, p.partner));
                EXPECT_LT((q.point - p.point - mean).norm(), 1e-15);
            }
        }
    expect_noise(diameter, 1e-4);
    expect_noise(coordinate, 2e-4);
    expect_noise(between_scans, 4e-8);  // product of two values: the product of their sigmas
    expect_noise(between_axes, 4e-8);
    expect_noise(size, 0.05);
    expect_noise(between_partners, 0.05 * 0.05);
    expect_noise(between_forces, 0.05 * 0.05);
}

TEST(measured, noise_depends_only_on_the_quantity_and_the_seed) {
    const Instrument instrument{{1e-4, 1e-4, 0.05, 0}, 0, 0, 0, 0};
    const Recording real = truth();
    Recording fewer = real;
    fewer.scans.resize(3);
    fewer.scans[1].contacts.clear();
    fewer.scans[2].contacts.erase(fewer.scans[2].contacts.begin());
    const Recording a = measured(real, instrument, 9), b = measured(fewer, instrument, 9);
    EXPECT_EQ(a.diameter, b.diameter);
    EXPECT_EQ(a.scans[2].position, b.scans[2].position);
    for (std::size_t c = 1; c < a.scans[2].contacts.size(); ++c)
        EXPECT_EQ(a.scans[2].contacts[c].force, b.scans[2].contacts[c - 1].force);
    const Recording other = measured(real, instrument, 10);
    EXPECT_NE(a.diameter[0], other.diameter[0]);
    EXPECT_NE(a.scans[1].position[0], other.scans[1].position[0]);
    EXPECT_NE(a.scans[1].contacts[0].force, other.scans[1].contacts[0].force);
}

TEST(measured, biases_scale_lengths_forces_and_plate_positions) {
    const Instrument instrument{{}, 0.1, 0, 0.02, 3e-4};
    const Recording real = truth(), seen = measured(real, instrument, 1);
    for (int s = 0; s < scans; ++s) {
        const Scan &p = real.scans[s], &q = seen.scans[s];
        EXPECT_DOUBLE_EQ(q.plate_z, p.plate_z + 3e-4);
        EXPECT_EQ(q.top_force(), p.top_force());
        EXPECT_NEAR((q.position[1] - q.position[0]).norm(), 1.02 * (p.position[1] - p.position[0]).norm(),
                    1e-15);
        EXPECT_NEAR(q.position[0].x(), 0.1 + 1.02 * (p.position[0].x() - 0.1), 1e-15);
        EXPECT_NEAR(q.position[0].z(), 1.02 * p.position[0].z(), 1e-15);
        if (s == 0) continue;
        EXPECT_LT((q.contacts[0].force - 1.1 * p.contacts[0].force).norm(), 1e-15);
        EXPECT_NEAR(q.contacts[0].point.y(), 0.05 + 1.02 * (p.contacts[0].point.y() - 0.05), 1e-15);
    }
    EXPECT_EQ(seen.plate_start, real.plate_start);
    EXPECT_EQ(seen.diameter, real.diameter);
}

/// One cycle of a plate that starts at 0.1 m: its heights, the forces on it, and the number of scans of
/// loading.
Recording one_cycle(const std::vector<double>& height, const std::vector<double>& force,
                    std::size_t loading) {
    Recording real = truth();
    real.plate_start = 0.1;
    real.scans.resize(height.size(), real.scans.back());
    for (std::size_t s = 0; s < height.size(); ++s) {
        Scan& scan = real.scans[s];
        scan.cycle = 0;
        scan.phase = s < loading ? Phase::load : Phase::unload;
        scan.plate_z = height[s];
        scan.wall_force[static_cast<std::size_t>(Wall::plate)].z() = force[s];
    }
    return real;
}

void expect_read(const Recording& real, const Instrument& instrument, const std::vector<double>& read) {
    const Recording seen = measured(real, instrument, 1);
    for (std::size_t s = 0; s < read.size(); ++s) {
        EXPECT_NEAR(seen.scans[s].top_force(), read[s], 1e-12) << s;
        EXPECT_EQ(seen.scans[s].plate_z, real.scans[s].plate_z);
    }
}

TEST(measured, gain_and_zero_of_a_gauge_drift_with_the_path_length_of_the_plate) {
    const Recording real = one_cycle({0.1, 0.09, 0.07, 0.08}, {0, 0.5, 2, 0.25}, 4);  // down, down, up
    Instrument gain, zero;
    gain.gauge_drift = 0.2;
    zero.zero_drift = -0.03;  // of the largest force
    expect_read(real, gain, {0, 0.5 * (1 + 0.2 / 6), 2 * (1 + 0.2 / 2), 0.25 * (1 + 0.2 / 1.5)});
    expect_read(real, zero, {0, 0.5 - 0.06 / 6, 2 - 0.06 / 2, 0.25 - 0.06 / 1.5});
    expect_read(one_cycle({0.1}, {3}, 1), gain, {3});
}

TEST(measured, gauge_drift_does_not_depend_on_the_end_of_the_recording) {
    Recording real = truth();
    real.plate_start = 0.1;
    real.scans.resize(8, real.scans.back());
    for (int s = 0; s < 8; ++s) {
        real.scans[s].plate_z = s % 4 == 2 ? 0.08 : s % 2 ? 0.09 : 0.1;
        real.scans[s].cycle = s / 4;
    }
    Instrument drifting;
    drifting.gauge_drift = 0.2;
    const Recording whole = measured(real, drifting, 1);
    EXPECT_DOUBLE_EQ(whole.scans[2].top_force(), (1 + 0.2 / 4) * real.scans[2].top_force());
    real.scans.resize(7);
    const Recording cut = measured(real, drifting, 1);
    for (int s = 0; s < 7; ++s) EXPECT_EQ(cut.scans[s].top_force(), whole.scans[s].top_force());
}

TEST(measured, a_gauge_with_hysteresis_reads_another_force_while_unloading) {
    Instrument instrument;
    instrument.gauge_hysteresis = 0.1;
    expect_read(one_cycle(std::vector<double>(6, 0.09), {0, 1, 4, 2, 1, 0}, 3), instrument,
                {0, 1, 4, 2.4, 1.3, 0});
}

TEST(measured, a_gauge_also_reads_the_friction_of_the_guide_once_the_plate_moves) {
    Instrument instrument;
    instrument.guide_friction = 0.05;
    expect_read(one_cycle({0.1, 0.09, 0.08, 0.09, 0.1}, {0, 1, 4, 1, 0}, 3), instrument,
                {0, 1.2, 4.2, 0.8, -0.2});
}

TEST(measured, a_late_top_force_is_that_of_an_earlier_plate) {
    // The plate rests at the fourth scan.
    const std::vector<double> force{0, 0.5, 2, 1.8, 1, 0}, late{0, 0.25, 1.625, 1.8, 1.4, 0.25},
        later{0, 0, 0.875, 1.8, 1.625, 0.75};
    const Recording real = one_cycle({0.1, 0.09, 0.07, 0.07, 0.08, 0.1}, force, 4);
    Instrument instrument;
    for (const auto& [lag, read] : {std::pair{0.0, force}, {0.005, late}, {0.015, later}}) {
        instrument.force_lag = lag;
        expect_read(real, instrument, read);
    }
}

TEST(measured, strong_contact_forces_saturate) {
    const Recording real = truth();
    Instrument saturating;
    saturating.force_saturation = 0.7;
    saturating.force_bias = 0.1;
    const Recording seen = measured(real, saturating, 1);
    for (std::size_t c = 0; c < real.scans[1].contacts.size(); ++c) {
        const Vec3& force = real.scans[1].contacts[c].force;
        const Vec3 expected = 1.1 * force / (1 + 0.7 * force.norm());
        EXPECT_LT((seen.scans[1].contacts[c].force - expected).norm(), 1e-15);
    }
    EXPECT_EQ(seen.scans[1].top_force(), real.scans[1].top_force());
}

TEST(measured, actual_threshold_includes_its_error_and_averages_use_the_stated_one) {
    const Recording real = truth();
    for (const double shift : {-0.05, 0.0, 0.05}) {
        const Instrument instrument{{0, 0, 0, 0.1}, 0.25, shift, 0, 0};
        const Scan seen = measured(real, instrument, 1).scans[1];
        std::size_t expected = 0, counted = 0;
        for (const Contact& contact : real.scans[1].contacts) {
            expected += 1.25 * contact.force.norm() >= 0.1 + shift;
            counted += 1.25 * contact.force.norm() >= std::max(0.1, 0.1 + shift);
        }
        EXPECT_EQ(seen.contacts.size(), expected);
        EXPECT_LT(expected, real.scans[1].contacts.size());
        double force = 0;
        for (const Contact& contact : seen.contacts)
            if (contact.force.norm() >= 0.1) force += contact.force.norm();
        EXPECT_NEAR(seen.mean_force, force / counted, 1e-12);
    }
}

TEST(measured, large_errors_do_not_reverse_forces) {
    const Recording real = truth(), seen = measured(real, {{0, 0, 3, 0}, 0, 0, 0, 0}, 1);
    for (std::size_t c = 0; c < seen.scans[1].contacts.size(); ++c)
        EXPECT_GE(seen.scans[1].contacts[c].force.dot(real.scans[1].contacts[c].force), 0);
}

TEST(measured, works_without_positions_and_contacts) {
    Recording real = truth();
    for (Scan& scan : real.scans) scan.contacts.clear();
    Recording bare = real;
    for (Scan& scan : bare.scans) scan.position.clear();
    EXPECT_EQ(measured(real, noisy, 1).scans[2].position.size(), static_cast<std::size_t>(grains));
    EXPECT_TRUE(measured(bare, noisy, 1).scans[2].position.empty());
    EXPECT_TRUE(std::isnan(measured(bare, noisy, 1).scans[2].mean_force));
    EXPECT_TRUE(measured({}, noisy, 1).scans.empty());
}

}  // namespace
}  // namespace mcdem::test::instrument
