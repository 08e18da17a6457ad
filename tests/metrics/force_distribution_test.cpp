#include "metrics/force_distribution.h"

#include <gtest/gtest.h>

#include <random>

#include "metrics/synthetic.h"

namespace mcdem {
namespace {

template <class Law>
std::vector<double> draw(Law law, int count, int seed) {
    std::mt19937_64 random(seed);
    std::vector<double> drawn(count);
    for (auto& x : drawn) x = law(random);
    return drawn;
}

double overlap(const std::vector<double>& p, const std::vector<double>& q) {
    const auto edges = common_edges(p, q, bin_count(p.size(), q.size()));
    return bhattacharyya(histogram(p, edges), histogram(q, edges));
}

TEST(Bhattacharyya, two_exponentials_agree_with_the_closed_form) {
    for (double ratio : {1.2, 1.5, 2.0, 4.0}) {
        const auto p = draw(std::exponential_distribution<>(1), 22500, 1);
        const auto q = draw(std::exponential_distribution<>(1 / ratio), 22500, 2);
        EXPECT_NEAR(overlap(p, q), 2 * std::sqrt(ratio) / (1 + ratio), 0.003) << ratio;
    }
}

TEST(Bhattacharyya, two_gaussians_agree_with_the_closed_form) {
    for (double shift : {0.5, 1.0, 2.0})
        for (double width : {1.0, 1.5}) {
            const auto p = draw(std::normal_distribution<>(10, 1), 22500, 3);
            const auto q = draw(std::normal_distribution<>(10 + shift, width), 22500, 4);
            const double s = 1 + width * width;
            const double exact = std::sqrt(2 * width / s) * std::exp(-shift * shift / (4 * s));
            EXPECT_NEAR(overlap(p, q), exact, 0.004) << shift << " " << width;
        }
}

TEST(Bhattacharyya, does_not_depend_on_the_scale_of_the_forces) {
    auto p = draw(std::exponential_distribution<>(1), 3000, 5),
         q = draw(std::exponential_distribution<>(2), 4000, 6);
    const double before = overlap(p, q);
    for (auto* list : {&p, &q})
        for (auto& f : *list) f = 7 * f * f * f;
    EXPECT_DOUBLE_EQ(overlap(p, q), before);
}

TEST(Bhattacharyya, is_zero_for_disjoint_samples_and_symmetric) {
    const auto p = draw(std::uniform_real_distribution<>(0, 1), 2000, 7);
    const auto q = draw(std::uniform_real_distribution<>(5, 6), 3000, 8);
    EXPECT_LT(overlap(p, q), 1.0 / bin_count(2000, 3000) + 0.005);  // at most one bin contains both
    const auto r = draw(std::exponential_distribution<>(2), 3000, 9);
    EXPECT_DOUBLE_EQ(overlap(p, r), overlap(r, p));
}

TEST(Bhattacharyya, counting_noise_is_corrected) {
    // The mean over many pairs of samples of one distribution is the bias. Without the correction it is (K -
    // 1) / 8 * 2 / n = 0.0059 for n = 1500 and K = 37 bins.
    double sum = 0;
    const int pairs = 100;
    for (int i = 0; i < pairs; ++i)
        sum += overlap(draw(std::gamma_distribution<>(1.5), 1500, 100 + i),
                       draw(std::gamma_distribution<>(1.5), 1500, 500 + i));
    EXPECT_NEAR(sum / pairs, 1, 1e-3);
}

TEST(Bhattacharyya, equal_forces_are_allowed) {
    EXPECT_NEAR(overlap(std::vector<double>(100, 2.0), std::vector<double>(50, 2.0)), 1, 1e-12);
}

DistributionDistance distance(const Replicas& simulated, const Replicas& reference) {
    const auto a = group_levels(simulated), b = group_levels(reference);
    return distribution_distance(a, b, match_levels(a, b),
                                 Jackknife(seeds_of(simulated), seeds_of(reference)));
}

TEST(Bhat, of_two_samples_of_one_distribution_is_small) {
    const auto a = synthetic::recording({.seed = 1, .cycles = 15, .levels = 2, .contacts = 1500});
    const auto b = synthetic::recording({.seed = 2, .cycles = 15, .levels = 2, .contacts = 1500});
    EXPECT_LT(distance({&a}, {&b}).bhat.value, 0.001);
    EXPECT_EQ(distance({&a}, {&b}).levels_used, 4);
}

TEST(Bhat, is_minus_log_of_the_mean_not_the_mean_of_logs) {
    auto a = synthetic::recording({.seed = 1, .levels = 1, .contacts = 20000});
    auto b = synthetic::recording({.seed = 2, .levels = 1, .contacts = 20000});
    for (auto& c : b.scans[0].contacts) c.force *= 16;  // B = 2 * 4 / 17 while loading, 1 while unloading
    EXPECT_NEAR(distance({&a}, {&b}).bhat.value, -std::log((8.0 / 17 + 1) / 2), 0.01);
}

TEST(Bhat, excludes_walls_and_levels_without_contacts) {
    auto a = synthetic::recording({.seed = 1, .levels = 2, .contacts = 5000});
    auto b = synthetic::recording({.seed = 2, .levels = 2, .contacts = 5000});
    for (auto& c : b.scans[0].contacts)
        if (is_wall(c.partner)) c.force *= 1000;
    b.scans[1].contacts.clear();
    EXPECT_LT(distance({&a}, {&b}).bhat.value, 0.003);
    EXPECT_EQ(distance({&a}, {&b}).levels_used, 3);
}

TEST(Bhat, standard_error_equals_the_scatter_of_repeated_experiments) {
    const auto measured = synthetic::recording({.seed = 999, .levels = 1, .contacts = 3000});
    std::vector<double> values, claimed;
    for (int repeat = 0; repeat < 16; ++repeat) {
        std::vector<Recording> made;
        for (int r = 0; r < 5; ++r)
            made.push_back(synthetic::recording(
                {.seed = 1 + repeat * 5 + r, .levels = 1, .contacts = 800, .mean_force = 90e-3}));
        const auto d = distance(replicas_of(made), {&measured});
        values.push_back(d.bhat.value);
        claimed.push_back(d.bhat.standard_error);
    }
    const double scatter = mean_over_replicas(values).standard_error * 4;
    EXPECT_GT(mean_over_replicas(claimed).value, 0.5 * scatter);
    EXPECT_LT(mean_over_replicas(claimed).value, 2.0 * scatter);
}

TEST(ForceDensity, integrates_to_one_and_agrees_with_the_distribution) {
    const auto recording = synthetic::recording({.levels = 1, .touch = -1e9, .contacts = 50000});
    const auto density = force_density(group_levels({&recording})[0], 40, 0.4);
    double sum = 0;
    for (const auto& d : density.density) sum += d.value * 0.01;
    EXPECT_NEAR(sum, 1, 0.001);
    const double mean = 0.05;
    EXPECT_NEAR(density.density[2].value, std::exp(-0.025 / mean) / mean, 0.3);
    EXPECT_DOUBLE_EQ(density.force[2], 0.025);
}

}  // namespace
}  // namespace mcdem
