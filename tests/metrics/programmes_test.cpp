// Runs with a programme are evaluated scan by scan, without levels of strokes.
#include "metrics/programmes.h"

#include <gmock/gmock.h>

#include "core/errors.h"
#include "metrics/levels.h"
#include "metrics/synthetic.h"

namespace mcdem {
namespace {

Recording recording_of(const std::vector<double>& forces, double later) {
    Recording recording;
    recording.label = "held";
    recording.parameters["programme.1.stage"] = "move";
    recording.plate_start = 0.1;
    for (std::size_t k = 0; k < forces.size(); ++k) {
        Scan scan;
        scan.frame = static_cast<int>(k);
        scan.time = later + static_cast<double>(k);
        scan.plate_z = 0.09;
        scan.wall_force[static_cast<int>(Wall::plate)] = {0, 0, forces[k]};
        recording.scans.push_back(scan);
    }
    return recording;
}

TEST(Programmes, MeansAreOverTheReplicasThatHaveTheScan) {
    const Recording whole = recording_of({3, 2, 1.5}, 0), broken = recording_of({5}, 0.5);
    const auto scans = mean_scans({&whole, &broken});
    ASSERT_EQ(scans.size(), 3u);
    EXPECT_EQ(scans[0].top_force.value, 4);
    EXPECT_EQ(scans[0].top_force.standard_error, 1);
    EXPECT_EQ(scans[0].time.value, 0.25);
    EXPECT_EQ(scans[2].top_force.value, 1.5);
    EXPECT_TRUE(std::isnan(scans[2].top_force.standard_error));
    EXPECT_NEAR(scans[1].displacement.value, 0.01, 1e-15);
}

TEST(Programmes, AreDistinguishedFromStrokes) {
    const Recording held = recording_of({1, 1}, 0);
    Recording stroke = held;
    stroke.parameters.clear();
    const std::vector<Setting> both{{"held", {&held}}, {"stroke", {&stroke}}};
    EXPECT_EQ(with_programme(both, true).front().label, "held");
    EXPECT_EQ(with_programme(both, false).front().label, "stroke");
    EXPECT_EQ(group_levels({&stroke}).size(), 1u);
    try {
        group_levels({&held});
        FAIL() << "two scans at one displacement and different times are no level";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("got one of a [[programme]]"));
    }
}

TEST(Programmes, OfCellsHaveStressesAndStrains) {
    const Recording one = synthetic::cell("mc_dem", 1), two = synthetic::cell("mc_dem", 2, 3);
    EXPECT_TRUE(are_cells({&one, &two}));
    const auto scans = mean_scans({&one, &two});
    ASSERT_EQ(scans.size(), 4u);
    const double gone = 1 - std::pow(0.98, 3);
    EXPECT_NEAR(scans[2].p.value, 2e5 * gone, 1e-9);
    EXPECT_NEAR(scans[2].p.standard_error, 1e5 * gone, 1e-9);
    EXPECT_NEAR(scans[2].q.value, 2e4 * gone * std::sqrt(3), 1e-9);
    EXPECT_NEAR(scans[1].q.value, 0, 1e-9);
    EXPECT_NEAR(scans[1].volume_strain.value, gone, 1e-15);
    EXPECT_EQ(scans[2].strain[4].value, 0.1);
    EXPECT_GT(scans[2].shear_strain.value, 0.05);
    EXPECT_NEAR(scans[3].packing_fraction.value, 0.62, 1e-15);
}

TEST(Programmes, HoldsAreFound) {
    Recording held = synthetic::cell("mc_dem");
    EXPECT_TRUE(has_hold({&held}));
    held.parameters.erase("programme.3.stage");
    EXPECT_FALSE(has_hold({&held}));
    const Recording stroke = synthetic::recording({});
    EXPECT_FALSE(are_cells({&stroke}));
}

}  // namespace
}  // namespace mcdem
