#include "calibrate/calibrate_gamma.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "core/errors.h"

namespace mcdem {
namespace {

using testing::HasSubstr;

/// Starts from Hertz at gamma = 0 and increases with increasing slope, like the real response.
double force(double gamma) { return 6.7 * std::exp(0.5 * gamma + 0.2 * gamma * gamma); }

struct Simulator {
    double noise = 0;  ///< relative standard deviation
    double limit = std::numeric_limits<double>::infinity();
    int seed = 1;
    int calls = 0;
    std::mt19937_64 random{static_cast<std::uint64_t>(seed)};

    std::vector<double> operator()(const std::vector<double>& gammas) {
        ++calls;
        std::vector<double> forces;
        for (double gamma : gammas)
            forces.push_back(gamma >= limit
                                 ? std::nan("")
                                 : force(gamma) * (1 + noise * std::normal_distribution<>()(random)));
        return forces;
    }
};

std::string message_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const std::exception& error) {
        return error.what();
    }
    return "no error";
}

TEST(CalibrateGamma, finds_the_root_of_a_smooth_response) {
    Simulator simulator;
    const auto found = calibrate_gamma(std::ref(simulator), force(1.125), {0.5, 1.6}, {.tolerance = 1e-4});
    EXPECT_TRUE(found.converged);
    EXPECT_NEAR(found.gamma, 1.125, 2e-4);
    EXPECT_LE(found.standard_error, 1e-4);
    EXPECT_EQ(found.rounds.size(), static_cast<std::size_t>(simulator.calls));
    EXPECT_LE(found.rounds.size(), 6u);
    EXPECT_EQ(found.rounds[0].gamma.size(), 6u);
    EXPECT_EQ(found.rounds.back().root, found.gamma);
}

TEST(CalibrateGamma, standard_error_is_correct_under_noise) {
    double squares = 0;
    const int repeats = 200;
    for (int seed = 1; seed <= repeats; ++seed) {
        Simulator simulator{.noise = 0.01, .seed = seed};
        const auto found = calibrate_gamma(std::ref(simulator), force(1.125), {0.5, 1.6},
                                           {.tolerance = 0.004, .batch = 8, .rounds = 12});
        ASSERT_TRUE(found.converged) << seed;
        squares += std::pow((found.gamma - 1.125) / found.standard_error, 2);
    }
    EXPECT_GT(std::sqrt(squares / repeats), 0.7);
    EXPECT_LT(std::sqrt(squares / repeats), 1.4);
}

TEST(CalibrateGamma, a_runaway_above_the_root_is_harmless) {
    Simulator simulator{.noise = 0.003, .limit = 1.2};
    const auto found = calibrate_gamma(std::ref(simulator), force(1.125), {0.4, 3.0}, {.rounds = 12});
    EXPECT_TRUE(found.converged);
    EXPECT_NEAR(found.gamma, 1.125, 4 * found.standard_error + 1e-3);
    EXPECT_GE(found.runs_away_at, 1.2);
}

TEST(CalibrateGamma, continues_below_a_runaway_without_repeating_simulations) {
    Simulator simulator{.limit = 1.2};
    const auto found = calibrate_gamma(std::ref(simulator), force(1.125), {1.0, 5.0});
    EXPECT_NEAR(found.gamma, 1.125, 1e-3);
    ASSERT_GE(found.rounds.size(), 2u);
    EXPECT_TRUE(std::isnan(found.rounds[0].root));
    for (double gamma : found.rounds[1].gamma) {
        EXPECT_GT(gamma, 1.0);
        EXPECT_LT(gamma, 1.8);  // the lowest of the first round that ran away
    }
}

TEST(CalibrateGamma, results_above_a_runaway_are_ignored) {
    const auto found = calibrate_gamma(
        [](const std::vector<double>& gammas) {
            std::vector<double> forces;
            for (double g : gammas)
                forces.push_back(g > 1.3 && g < 1.45 ? std::nan("") : g > 1.3 ? 1.0 : force(g));
            return forces;
        },
        force(1.1), {0.5, 1.6}, {.batch = 12});
    EXPECT_NEAR(found.gamma, 1.1, 1e-3);
}

TEST(CalibrateGamma, runaway_before_the_target_is_reported) {
    Simulator simulator{.limit = 0.9};
    EXPECT_THAT(message_of([&] {
                    calibrate_gamma(std::ref(simulator), force(1.1), {0.4, 1.6});
                }),
                HasSubstr("no gamma gives Rtop = 1"));
    Simulator everywhere{.limit = 0.1};
    EXPECT_THAT(message_of([&] {
                    calibrate_gamma(std::ref(everywhere), force(1.1), {0.4, 1.6});
                }),
                HasSubstr("runs away already at gamma = 0.4"));
}

TEST(CalibrateGamma, target_outside_the_bracket_is_reported) {
    Simulator simulator;
    EXPECT_THAT(message_of([&] {
                    calibrate_gamma(std::ref(simulator), force(0.2), {0.4, 1.6});
                }),
                HasSubstr("starts lower"));
    EXPECT_THAT(message_of([&] {
                    calibrate_gamma(std::ref(simulator), force(2.0), {0.4, 1.6});
                }),
                HasSubstr("ends higher than 1.6"));
}

TEST(CalibrateGamma, exhausted_rounds_are_not_converged) {
    Simulator simulator{.noise = 0.05};
    const auto found =
        calibrate_gamma(std::ref(simulator), force(1.1), {0.4, 1.6}, {.tolerance = 1e-5, .rounds = 3});
    EXPECT_FALSE(found.converged);
    EXPECT_EQ(found.rounds.size(), 3u);
    EXPECT_NEAR(found.gamma, 1.1, 0.1);
}

TEST(CalibrateGamma, all_input_problems_are_reported_at_once) {
    const auto told = message_of([] {
        calibrate_gamma([](const auto& g) { return g; }, -1, {1.5, 0.5},
                        {.tolerance = 0, .batch = 1, .rounds = 0});
    });
    for (const char* word : {"target", "bracket", "tolerance", "batch", "rounds"})
        EXPECT_THAT(told, HasSubstr(word));
}

TEST(CalibrateGamma, a_wrong_result_of_the_simulator_is_reported) {
    EXPECT_THAT(message_of([] {
                    calibrate_gamma([](const auto&) { return std::vector<double>{1}; }, 10, {0.5, 1.5});
                }),
                HasSubstr("asked for 6 top forces, got 1"));
}

}  // namespace
}  // namespace mcdem
