// Runs a protocol on a law of forces instead of a packing.
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/protocol.h"

namespace mcdem {

/// Where an interval ends: the plate [m], or the strains of a cell.
struct IntervalEnd {
    IntervalEnd(const StepInterval& interval, double time_step)
        : plate_z(interval.plate_z +
                  interval.plate_velocity * interval.steps * interval.step_part * time_step),
          strain(interval.strain) {
        for (std::size_t k = 0; k < strain.size(); ++k)
            strain[k] += interval.strain_rate[k] * interval.steps * interval.step_part * time_step;
    }
    double plate_z;
    Strain strain;
};

/// Until the protocol has finished. `respond(end, result)` sets the forces at the end of an interval;
/// `watch(before, interval, end, scan)` gets the state before it and the scan after it, if there is one.
template <class Respond, class Watch>
void drive(ProtocolRunner& runner, double time_step, int longest, Respond respond, Watch watch) {
    for (int rounds = 0; !runner.finished(); ++rounds) {
        ASSERT_LT(rounds, 400000);
        const StepInterval interval = runner.next([&](const StepInterval&) { return longest; });
        ASSERT_GE(interval.steps, 1);
        ASSERT_LE(interval.steps, longest);
        const IntervalEnd end(interval, time_step);
        IntervalResult result;
        result.steps = interval.steps;
        result.elastic_energy = 1;
        respond(end, result);
        const ProtocolState before = runner.state();
        const auto scan = runner.on_interval_done(result);
        watch(before, interval, end, scan);
    }
    EXPECT_EQ(runner.next([](const StepInterval&) { return 60; }).steps, 0);
}

/// The same force on plate and floor [N].
inline void set_force(IntervalResult& result, double force) {
    result.wall_force[static_cast<int>(Wall::plate)] = {0, 0, force};
    result.wall_force[static_cast<int>(Wall::floor)] = {0, 0, -force};
}

}  // namespace mcdem
