// Viscoelasticity: each contact is a standard linear solid.
#include "sim/squeezed_grain.h"

namespace mcdem::reference {
namespace {

mcdem::Effects relaxing(double part, double time) {
    mcdem::Effects effects;
    effects.viscoelasticity = part;
    effects.relaxation_time = time;
    return effects;
}

constexpr double part = 0.4, time_constant = 2e-3, overlap = 5e-4;

TEST(Relaxation, AtConstantOverlapIsExponential) {
    SqueezedGrain grain(relaxing(part, time_constant), overlap);
    const double elastic = SqueezedGrain::hertz(overlap);
    const int steps = static_cast<int>(6 * time_constant / grain.time_step());
    ASSERT_GT(steps, 50);
    double force = 0;
    for (int step = 1; step <= steps; ++step) {
        force = grain.squeeze(0);
        const double relaxed = 1 - std::exp(-step * grain.time_step() / time_constant);
        EXPECT_NEAR(force / elastic, 1 - part * relaxed, 10 * SqueezedGrain::rounding()) << step;
    }
    EXPECT_NEAR(force / elastic, 1 - part, 2e-3) << "what is left at the end";
}

/// F_H(t) - a/T times the integral of F_H(s) exp(-(t - s)/T), by Simpson's rule; overlap(s) = rate * s.
double ramp_force(double t, double rate) {
    constexpr int intervals = 2000;
    double sum = 0;
    for (int k = 0; k <= intervals; ++k) {
        const double s = t * k / intervals;
        const double weight = k == 0 || k == intervals ? 1 : k % 2 ? 4 : 2;
        sum += weight * SqueezedGrain::hertz(rate * s) * std::exp(-(t - s) / time_constant);
    }
    return SqueezedGrain::hertz(rate * t) - part / time_constant * sum * t / intervals / 3;
}

// A step uses the force at its start for the whole step, so it lags by half a step: dt/(2 T) of the relaxed
// part.
TEST(Relaxation, ForceOfARampIsTheIntegralOverItsHistory) {
    SqueezedGrain grain(relaxing(part, time_constant), 0);
    const int steps = static_cast<int>(3 * time_constant / grain.time_step());
    const double late = grain.time_step() / time_constant;
    for (int step = 1; step <= steps; ++step) {
        const double force = grain.squeeze(overlap / steps), t = step * grain.time_step();
        const double expected = ramp_force(t, overlap / (steps * grain.time_step()));
        EXPECT_NEAR(force, expected, 0.6 * late * part * SqueezedGrain::hertz(grain.overlap()) + 1e-9)
            << step;
    }
    EXPECT_LT(late, 0.06);
}

// If the grain is withdrawn faster than the contact recovers, the force is zero, not attractive.
TEST(Relaxation, DoesNotPull) {
    SqueezedGrain grain(relaxing(0.9, time_constant), overlap);
    grain.path(0, 200);
    bool let_go = false;
    for (const auto& point : grain.path(-overlap, 20)) {
        EXPECT_GE(point.force, 0) << point.overlap;
        let_go |= point.force == 0 && point.overlap > 0.1 * overlap;
    }
    EXPECT_TRUE(let_go);
}

// The relaxed part recovers without contact, with the same time constant.
TEST(Relaxation, RecoversWithoutContact) {
    SqueezedGrain grain(relaxing(part, time_constant), overlap);
    grain.path(0, 2000);
    grain.squeeze(-1.01 * overlap);
    const int steps = static_cast<int>(time_constant / grain.time_step());
    for (const auto& point : grain.path(0, steps - 1)) EXPECT_EQ(point.force, 0);
    const double force = grain.squeeze(1.01 * overlap);
    const double left = std::exp(-steps * grain.time_step() / time_constant);
    EXPECT_NEAR(force / SqueezedGrain::hertz(overlap), 1 - part * left, 100 * SqueezedGrain::rounding());
}

}  // namespace
}  // namespace mcdem::reference
