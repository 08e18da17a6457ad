#include "metrics/estimate.h"

#include <gtest/gtest.h>

#include <random>

namespace mcdem {
namespace {

TEST(Estimate, mean_and_standard_error_of_known_numbers) {
    const std::vector<double> values{1, 2, not_available, 3, 4};
    const auto mean = mean_over_replicas(values);
    EXPECT_DOUBLE_EQ(mean.value, 2.5);
    EXPECT_DOUBLE_EQ(mean.standard_error, std::sqrt(5.0 / 3 / 4));
    EXPECT_EQ(mean.count, 4);
}

TEST(Estimate, one_replica_has_no_error_and_none_has_no_value) {
    const std::vector<double> one{3}, none{not_available};
    EXPECT_DOUBLE_EQ(mean_over_replicas(one).value, 3);
    EXPECT_TRUE(std::isnan(mean_over_replicas(one).standard_error));
    EXPECT_FALSE(mean_over_replicas(none).available());
}

TEST(PairBySeed, requires_the_same_seeds_each_once) {
    const auto pairs = pair_by_seed({"1", "2", "3"}, {"3", "1", "2"});
    ASSERT_TRUE(pairs);
    EXPECT_EQ(*pairs, (Pairs{{0, 1}, {1, 2}, {2, 0}}));
    EXPECT_FALSE(pair_by_seed({"1", "2"}, {"1", "3"}));
    EXPECT_FALSE(pair_by_seed({"1", "2"}, {"1", "2", "3"}));
    EXPECT_FALSE(pair_by_seed({"1", "1"}, {"1", "2"}));
    EXPECT_FALSE(pair_by_seed({"", ""}, {"", ""}));
}

TEST(RatioOfMeans, common_scatter_of_a_pair_cancels) {
    const Sample above{{"1", "2", "3"}, {0.5, 1.0, 1.5}}, below{{"3", "2", "1"}, {3, 2, 1}};
    const auto ratio = ratio_of_means(above, below);
    EXPECT_DOUBLE_EQ(ratio.value, 0.5);
    EXPECT_NEAR(ratio.standard_error, 0, 1e-15);
}

TEST(RatioOfMeans, a_pair_with_a_failed_replica_is_excluded) {
    const Sample above{{"1", "2", "3"}, {1, 1, 100}}, below{{"1", "2", "3"}, {2, 2, not_available}};
    EXPECT_DOUBLE_EQ(ratio_of_means(above, below).value, 0.5);
    EXPECT_EQ(ratio_of_means(above, below).count, 2);
}

TEST(RatioOfMeans, unpaired_errors_add_in_quadrature) {
    const Sample above{{"1", "2"}, {9, 11}}, below{{"5", "6"}, {19, 21}};  // standard errors 1 and 1
    EXPECT_DOUBLE_EQ(ratio_of_means(above, below).value, 0.5);
    EXPECT_DOUBLE_EQ(ratio_of_means(above, below).standard_error, std::hypot(1.0 / 20, 0.5 / 20));
    const Sample experiment{{""}, {20}};
    EXPECT_DOUBLE_EQ(ratio_of_means(above, experiment).standard_error, 1.0 / 20);
}

TEST(Jackknife, of_a_mean_is_its_standard_error) {
    const std::vector<double> values{1, 4, 9, 16, 25};
    const Jackknife jackknife({"1", "2", "3", "4", "5"}, {""});
    std::vector<double> means;
    for (const auto& omission : jackknife.omissions()) {
        auto kept = values;
        if (omission.simulated >= 0) kept.erase(kept.begin() + omission.simulated);
        means.push_back(mean_over_replicas(kept).value);
    }
    EXPECT_NEAR(jackknife.estimate(means).standard_error, mean_over_replicas(values).standard_error, 1e-12);
    EXPECT_EQ(jackknife.estimate(means).value, means.front());
    EXPECT_EQ(jackknife.estimate(means).count, 5);
}

TEST(Jackknife, omits_pairs_together_and_others_one_by_one) {
    EXPECT_EQ(Jackknife({"1", "2", "3"}, {"3", "2", "1"}).omissions().size(), 4u);
    EXPECT_EQ(Jackknife({"1", "2", "3"}, {"7", "8", "9"}).omissions().size(), 7u);
    EXPECT_EQ(Jackknife({"1"}, {""}).omissions().size(), 1u);
    const auto first = Jackknife({"1", "2"}, {"2", "1"}).omissions()[1];
    EXPECT_EQ(first.simulated, 0);
    EXPECT_EQ(first.reference, 1);
}

TEST(Jackknife, variances_of_both_sides_add) {
    const std::vector<double> a{1, 2, 4}, b{10, 30};
    const Jackknife jackknife({"1", "2", "3"}, {"", ""});
    std::vector<double> differences;
    for (const auto& omission : jackknife.omissions()) {
        auto kept_a = a, kept_b = b;
        if (omission.simulated >= 0) kept_a.erase(kept_a.begin() + omission.simulated);
        if (omission.reference >= 0) kept_b.erase(kept_b.begin() + omission.reference);
        differences.push_back(mean_over_replicas(kept_a).value - mean_over_replicas(kept_b).value);
    }
    EXPECT_NEAR(jackknife.estimate(differences).standard_error,
                std::hypot(mean_over_replicas(a).standard_error, mean_over_replicas(b).standard_error),
                1e-12);
}

}  // namespace
}  // namespace mcdem
