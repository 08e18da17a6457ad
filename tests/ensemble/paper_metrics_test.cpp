// The paper's metrics before and after a gap is closed, for recordings with known forces.
#include "ensemble/diagnosis/paper_metrics.h"

#include <gtest/gtest.h>

#include "metrics/estimate.h"

namespace mcdem {
namespace {

/// Loading and unloading; the top force is `stiffness` times the square of the displacement.
Recording stroke(double stiffness) {
    Recording recording;
    recording.plate_start = 0.1;
    for (const Phase phase : {Phase::load, Phase::unload})
        for (int k = 1; k <= 5; ++k) {
            Scan scan;
            scan.frame = static_cast<int>(recording.scans.size());
            scan.phase = phase;
            scan.coordination_number = scan.mean_force = not_available;
            const double displacement = 0.002 * (phase == Phase::load ? k : 6 - k);
            scan.plate_z = 0.1 - displacement;
            scan.wall_force[static_cast<int>(Wall::plate)].z() = stiffness * displacement * displacement;
            recording.scans.push_back(scan);
        }
    return recording;
}

TEST(PaperMetrics, BeforeAndAfterAreCorrect) {
    const double stiffness = 1e4;  // 1 N at 10 mm
    const PaperMetrics metrics = paper_metrics(
        stroke(stiffness), {{stroke(0.5 * stiffness), stroke(0.7 * stiffness)}, {stroke(1.1 * stiffness)}});
    ASSERT_EQ(metrics.values.size(), 2u);  // no contacts: without errZ and bhat
    const auto& [Rtop, ratios] = metrics.values[0];
    const auto& [errf, errors] = metrics.values[1];
    EXPECT_EQ(Rtop, "Rtop");
    EXPECT_NEAR(ratios[0], 0.6, 1e-12);
    EXPECT_NEAR(ratios[1], 1.1, 1e-12);
    // Root mean square over the levels, equal for loading and unloading: 0.04 k^2 N.
    const double mean_square = 0.04 * 0.04 * (1 + 16 + 81 + 256 + 625) / 5;
    EXPECT_EQ(errf, "errf");
    EXPECT_NEAR(errors[0], 0.4 * std::sqrt(mean_square), 1e-12);
    EXPECT_NEAR(errors[1], 0.1 * std::sqrt(mean_square), 1e-12);
    ASSERT_EQ(metrics.top_force.size(), 5u);
    for (int k = 1; k <= 5; ++k) {
        const auto& row = metrics.top_force[static_cast<std::size_t>(k - 1)];
        EXPECT_NEAR(row[0], 0.002 * k, 1e-12);
        EXPECT_NEAR(row[1], 0.04 * k * k, 1e-12);
        EXPECT_NEAR(row[2], 0.6 * 0.04 * k * k, 1e-12);
        EXPECT_NEAR(row[3], 1.1 * 0.04 * k * k, 1e-12);
    }
}

}  // namespace
}  // namespace mcdem
