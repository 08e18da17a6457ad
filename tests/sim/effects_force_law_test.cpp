// Stiffening and plasticity: force of a single contact against its overlap.
#include "sim/squeezed_grain.h"

namespace mcdem::reference {
namespace {

constexpr double deepest = 1e-3;

mcdem::Effects stiffening(double amount) {
    mcdem::Effects effects;
    effects.stiffening = amount;
    return effects;
}

mcdem::Effects plasticity(double part) {
    mcdem::Effects effects;
    effects.plasticity = part;
    return effects;
}

/// The work of the plate is the energy stored in both contacts; the trapezoidal rule over 200 steps has an
/// error of about 1e-5.
void expect_law(double amount, double (*factor)(double), double energy_error) {
    SqueezedGrain grain(stiffening(amount), 0);
    const auto path = grain.path(deepest, 200);
    for (const auto& [overlap, force, energy, work] : path) {
        const double expected =
            SqueezedGrain::hertz(overlap) * factor(amount * overlap / SqueezedGrain::radius);
        EXPECT_NEAR(force / expected, 1, 10 * SqueezedGrain::rounding()) << overlap;
    }
    EXPECT_NEAR(path.back().energy / path.back().work, 1, energy_error) << amount;
}

TEST(Stiffening, MultipliesTheHertzForceByOnePlusOverlapOverRadius) {
    for (double amount : {1.0, 5.0})
        expect_law(
            amount, [](double x) { return 1 + x; }, 1e-4);
}

// Softening divides instead, so that the force increases at any overlap.
TEST(Stiffening, NegativeValuesDivide) {
    for (double amount : {-1.0, -20.0})
        expect_law(
            amount, [](double x) { return 1 / (1 - x); }, 0.03);
}

// The energy of a power of the overlap is exact.
TEST(LawExponent, IsAddedToHertzs) {
    for (double exponent : {-0.5, 0.15, 1.0}) {
        mcdem::Effects effects;
        effects.law_exponent = exponent;
        SqueezedGrain grain(effects, 0);
        const auto path = grain.path(deepest, 200);
        for (const auto& [overlap, force, energy, work] : path) {
            const double factor = std::pow(overlap / (0.1 * SqueezedGrain::radius), exponent);
            EXPECT_NEAR(force / (SqueezedGrain::hertz(overlap) * factor), 1, 10 * SqueezedGrain::rounding());
        }
        EXPECT_NEAR(path.back().energy / path.back().work, 1, 1e-4) << exponent;
    }
}

/// Loading and unloading in steps of a hundredth of `deepest`.
std::vector<SqueezedGrain::Point> go(SqueezedGrain& grain, double target) {
    const double change = target - grain.overlap();
    return grain.path(change, static_cast<int>(std::lround(100 * std::abs(change) / deepest)));
}

TEST(Plasticity, UnloadsAlongASteeperHertzCurve) {
    for (double part : {0.1, 0.5}) {
        SqueezedGrain grain(plasticity(part), 0);
        for (const auto& p : go(grain, deepest))
            EXPECT_NEAR(p.force / SqueezedGrain::hertz(p.overlap), 1, 10 * SqueezedGrain::rounding());
        const double residual = part * deepest;
        for (const auto& p : go(grain, 0)) {
            const double left = std::max(0.0, (p.overlap - residual) / (deepest - residual));
            EXPECT_NEAR(p.force / SqueezedGrain::hertz(deepest), std::pow(left, 1.5),
                        10 * SqueezedGrain::rounding());
        }
    }
}

// Loading takes the work 2/5 F d_max; unloading returns 1 - p of it. The trapezoidal rule has an error of
// 5e-5.
TEST(Plasticity, LoopAreaIsThePlasticPartOfTheWork) {
    for (double part : {0.1, 0.5}) {
        SqueezedGrain grain(plasticity(part), 0);
        const double force = SqueezedGrain::hertz(deepest);
        const auto in = go(grain, deepest).back();
        EXPECT_NEAR(in.energy / (2 * (1 - part) * 0.4 * force * deepest), 1, 1e-4) << "what can be got back";
        const double back = go(grain, 0).back().work;
        EXPECT_NEAR((in.work + back) / (2 * part * 0.4 * force * deepest), 1, 1e-3);
    }
}

TEST(Plasticity, ReloadsAlongTheUnloadingCurveThenFollowsHertz) {
    SqueezedGrain grain(plasticity(0.3), 0);
    go(grain, deepest);
    const auto down = go(grain, 0.2 * deepest), up = go(grain, deepest);
    for (std::size_t k = 0; k + 1 < up.size(); ++k)
        EXPECT_NEAR(up[k].force, down[down.size() - 2 - k].force, 1e-6 * SqueezedGrain::hertz(deepest));
    for (const auto& p : go(grain, 1.5 * deepest))
        EXPECT_NEAR(p.force / SqueezedGrain::hertz(p.overlap), 1, 10 * SqueezedGrain::rounding());
}

}  // namespace
}  // namespace mcdem::reference
