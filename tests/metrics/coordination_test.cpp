#include "metrics/coordination.h"

#include <gtest/gtest.h>

#include "metrics/synthetic.h"

namespace mcdem {
namespace {

Contact contact(int grain, int partner, double force) {
    Contact made;
    made.grain = grain;
    made.partner = partner;
    made.force = {0, 0.6 * force, -0.8 * force};
    return made;
}

/// Three grains: two contacts between grains (1 N and 3 N), one with the floor (2 N).
Recording three_grains() {
    Recording made;
    made.diameter = {1, 1, 1};
    Scan scan;
    scan.contacts = {contact(0, 1, 1), contact(1, 2, 3), contact(0, wall_partner(Wall::floor), 2)};
    made.scans = {scan};
    return made;
}

double z_at(const Recording& recording, double tau) {
    const Replicas replicas{&recording};
    return Coordination(group_levels(replicas), replicas).at_threshold(tau)(0, 0);
}

TEST(Coordination, grain_contacts_count_twice_wall_contacts_once) {
    EXPECT_DOUBLE_EQ(z_at(three_grains(), 0), 5.0 / 3);
}

TEST(Coordination, includes_forces_equal_to_the_threshold) {
    EXPECT_DOUBLE_EQ(z_at(three_grains(), 1.01), 3.0 / 3);
    EXPECT_DOUBLE_EQ(z_at(three_grains(), 2.01), 2.0 / 3);
    EXPECT_DOUBLE_EQ(z_at(three_grains(), 3.01), 0);
    auto exact = three_grains();
    for (auto& c : exact.scans[0].contacts) c.force = {0, 0, c.force.norm() > 2.5 ? 3.0 : 2.0};
    EXPECT_DOUBLE_EQ(z_at(exact, 2), 5.0 / 3);
}

TEST(Coordination, unrecorded_contacts_are_not_zero_contacts) {
    auto recording = three_grains();
    recording.scans[0].contacts.clear();
    recording.scans[0].coordination_number = 6.4;
    EXPECT_TRUE(std::isnan(z_at(recording, 0)));
    recording.scans[0].coordination_number = 0;
    EXPECT_DOUBLE_EQ(z_at(recording, 0), 0);
}

CoordinationError error_between(const Replicas& simulated, const Replicas& reference) {
    const auto a = group_levels(simulated), b = group_levels(reference);
    return coordination_error(a, simulated, reference_coordination(b, reference), match_levels(a, b),
                              Jackknife(seeds_of(simulated), seeds_of(reference)));
}

TEST(ErrZ, finds_the_threshold_of_the_reference) {
    const auto simulated = synthetic::recording({.cycles = 2, .contacts = 2000});
    auto measured = simulated;
    for (auto& scan : measured.scans)
        std::erase_if(scan.contacts, [](const Contact& c) { return c.force.norm() < 4e-3; });
    const auto error = error_between({&simulated}, {&measured});
    EXPECT_NEAR(error.errZ.value, 0, 1e-12);
    EXPECT_NEAR(error.tau.value, 4e-3, 5e-6);  // to the spacing of the forces near 4 mN
    EXPECT_EQ(error.levels_used, 20);
}

TEST(ErrZ, is_the_rms_at_the_best_threshold) {
    // Two levels with equal forces cannot fit both Z + 1 and Z - 1 of a reference: the smallest error is 1.
    auto simulated = synthetic::recording({.levels = 1, .touch = -1e9, .contacts = 5000});
    simulated.scans[1].contacts = simulated.scans[0].contacts;
    auto measured = simulated;
    for (auto& scan : measured.scans) scan.contacts.clear();
    measured.scans[0].coordination_number = 50 + 1;
    measured.scans[1].coordination_number = 50 - 1;
    const auto error = error_between({&simulated}, {&measured});
    EXPECT_NEAR(error.errZ.value, 1, 1e-3);
    const double z = z_at(simulated, error.tau.value);
    EXPECT_NEAR(z, 50, 0.05);
}

TEST(ErrZ, compared_with_itself_needs_no_threshold) {
    const auto recording = synthetic::recording({.contacts = 500});
    const auto error = error_between({&recording}, {&recording});
    EXPECT_EQ(error.errZ.value, 0);
    EXPECT_EQ(error.tau.value, 0);
}

TEST(ErrZ, without_contacts_uses_the_recorded_coordination) {
    auto simulated = synthetic::recording({}), measured = simulated;
    for (auto& scan : measured.scans) scan.coordination_number -= 0.25;
    const auto error = error_between({&simulated}, {&measured});
    EXPECT_NEAR(error.errZ.value, 0.25, 1e-12);
    EXPECT_FALSE(error.tau.available());
}

TEST(ErrZ, standard_errors_equal_the_scatter_of_repeated_experiments) {
    auto measured = synthetic::recording({.seed = 999, .levels = 2, .contacts = 2000});
    for (auto& scan : measured.scans)
        std::erase_if(scan.contacts, [](const Contact& c) { return c.force.norm() < 4e-3; });
    std::vector<double> taus, claimed;
    for (int repeat = 0; repeat < 12; ++repeat) {
        std::vector<Recording> made;
        for (int r = 0; r < 6; ++r)
            made.push_back(synthetic::recording({.seed = 1 + repeat * 6 + r, .levels = 2, .contacts = 2000}));
        const auto error = error_between(replicas_of(made), {&measured});
        taus.push_back(error.tau.value);
        claimed.push_back(error.tau.standard_error);
    }
    const double scatter = mean_over_replicas(taus).standard_error * std::sqrt(12.0);
    const double mean_claim = mean_over_replicas(claimed).value;
    EXPECT_GT(mean_claim, 0.5 * scatter);
    EXPECT_LT(mean_claim, 2.0 * scatter);
}

}  // namespace
}  // namespace mcdem
