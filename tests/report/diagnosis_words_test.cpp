#include "report/diagnosis/diagnosis_words.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mcdem {
namespace {

TEST(DiagnosisWords, names_are_readable) {
    EXPECT_EQ(words_of("cross_contact"), "cross-contact deformation");
    EXPECT_EQ(words_of("some_new_effect"), "some new effect");
    EXPECT_EQ(words_of("a\nb"), "a b");
}

TEST(DiagnosisWords, lists_are_joined) {
    EXPECT_EQ(listed({}), "");
    EXPECT_EQ(listed({"a"}), "a");
    EXPECT_EQ(listed({"a", "b", "c"}), "a, b and c");
    EXPECT_EQ(listed({"a", "b", "c", "d"}, 2), "a, b and 2 more");
}

TEST(DiagnosisWords, amounts_have_common_units) {
    EXPECT_EQ(amount(2.5e-4, "J/m2"), "0.25 mJ/m²");
    EXPECT_EQ(amount(1.234e-4, "m"), "0.123 mm");
    EXPECT_EQ(amount(4e-3, "N"), "4 mN");
    EXPECT_EQ(amount(2300, "Pa"), "2.3 kPa");
    EXPECT_EQ(amount(0.05, "relative"), "5 %");
    EXPECT_EQ(amount(0.05, ""), "0.05");
    EXPECT_EQ(amount(7, "furlong"), "7 furlong");
    EXPECT_EQ(amount(INFINITY, "m"), "–");
}

TEST(DiagnosisWords, decimals_follow_from_the_error) {
    EXPECT_EQ(amount(4.213e-4, 0.53e-4, "J/m2"), "0.421 ± 0.053 mJ/m²");
    EXPECT_EQ(amount(123.456, 17, ""), "123 ± 17");
    EXPECT_EQ(amount(2300, 200, "Pa", Sign::always), "+2.30 ± 0.20 kPa");
    EXPECT_EQ(amount(-2300, 200, "Pa", Sign::always), "-2.30 ± 0.20 kPa");
    EXPECT_EQ(amount(0.1234, 0, ""), "0.123");
    EXPECT_EQ(amount(0.1234, std::nan(""), "", Sign::always), "+0.123");
}

TEST(DiagnosisWords, percentages_and_probabilities_are_rounded) {
    EXPECT_EQ(percent(0.814), "81 %");
    EXPECT_EQ(percent(0.001), "< 1 %");
    EXPECT_EQ(percent(0), "0 %");
    EXPECT_EQ(percent(-0.001), "0 %");
    EXPECT_EQ(percent(-0.06), "-6 %");
    EXPECT_EQ(p_words(0.0040), "p = 0.004");
    EXPECT_EQ(p_words(0.4432), "p = 0.44");
    EXPECT_EQ(p_words(1e-7), "p < 0.0001");
}

TEST(DiagnosisWords, positions_are_described) {
    WhereEntry entry{"top_force", "load", {18e-3, 24e-3}, {}, {}, 6.13, 0.4, 0.1};
    EXPECT_EQ(where_words(entry),
              "top force while loading, at a displacement of 18 to 24 mm: 11 % higher than simulated (6.1 "
              "sigma, 0.4 after "
              "recalibration)");
    entry = {"mean_force", "", {0, 0}, "floor", "weak", -4, -4};
    EXPECT_EQ(where_words(entry),
              "mean force, floor, weak: lower than simulated (-4.0 sigma, -4.0 after recalibration)");
    EXPECT_EQ(displacement_words({18e-3, 18e-3}), "18 mm");
    EXPECT_EQ(phase_words(""), "both phases");
}

TEST(DiagnosisWords, signs_are_described_as_directions) {
    EXPECT_EQ(directed_amount("modulus", std::log(0.95), 0.01, "relative"),
              "5.00 ± 0.95 % lower than stated");
    EXPECT_EQ(directed_amount("diameter_error", 2e-4, 1e-5, "m"), "0.200 ± 0.010 mm larger than stated");
    EXPECT_EQ(directed_amount("force_bias", -0.1, 0.01, "relative"), "10.0 ± 1.0 % too low");
    EXPECT_EQ(directed_amount("adhesion", 4e-4, 5e-5, "J/m2"), "0.400 ± 0.050 mJ/m²");
    EXPECT_EQ(directed_amount("friction", 0, 0.01, ""), "0.000 ± 0.010");
    EXPECT_EQ(directed_amount("friction", 0.1, INFINITY, ""), "–");
}

TEST(DiagnosisWords, suspects_are_the_best_parameter_or_those_at_their_bounds) {
    Diagnosis d;
    d.nuisances = {{"gamma", 0.2, 0.01, 0.05, "", true},
                   {"modulus", 0.3, 0.02, 0.05, "relative", true},
                   {"friction", 0.001, 0.001, 0.01, "", false}};
    auto suspects = suspects_of(d);
    ASSERT_EQ(suspects.size(), 2u);
    EXPECT_EQ(suspects[0].name, "modulus");  // 6 sigma, before 4
    EXPECT_EQ(suspect_words(suspects[0]),
              "modulus of the grains: 35.0 ± 2.7 % higher than stated (6.0 times its stated error)");
    d.causes.push_back({.effect = "friction",
                        .amplitude = 0.08,
                        .amplitude_error = 0.01,
                        .unit = "",
                        .group = {},
                        .confirmed_score = {}});
    suspects = suspects_of(d);
    ASSERT_EQ(suspects.size(), 1u);
    EXPECT_EQ(suspect_words(suspects[0]),
              "friction between grains: 0.080 ± 0.010 higher than in the scene (8.0 times its stated error)");
    EXPECT_EQ(cause_words(d.causes[0]), "friction between grains (0.080 ± 0.010 higher than in the scene)");
    d.causes[0].at_limit = true;
    EXPECT_EQ(
        cause_words(d.causes[0]),
        "friction between grains (0.080 ± 0.010 higher than in the scene, or more: it is at the limit of "
        "the range tried)");
}

}  // namespace
}  // namespace mcdem
