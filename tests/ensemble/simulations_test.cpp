// The simulations that a diagnosis asks for: libraries of tiny packings.
#include "ensemble/diagnosis/simulations.h"

#include <gmock/gmock.h>

#include "ensemble/small_trials.h"

namespace mcdem {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Key;
using ::testing::UnorderedElementsAre;

struct SmallSimulations : testing::Test {
    SmallSimulations() {
        plan.library.packings = {{small.model, small.packing}};
        plan.library.replicates = 3;
        plan.library.pairs = 2;
        plan.library.jitter = plan.library.diameter_jitter = 1e-5;
        plan.library.candidates = {"force_bias", "plate_tilt"};
        plan.library.nuisances = nuisances(small.model, {});
        plan.common = small.common;
    }
    Simulations simulations() const { return {plan, small.folder.path / "simulations", ""}; }
    Eigen::MatrixXd observed(const std::vector<Trial>& trials) const {
        Device device;
        return observe_trials(device, small.common, trials, small.store, {});
    }

    SmallTrials small;
    DiagnosisPlan plan;
};

TEST_F(SmallSimulations, OfALibraryAreBaselineEffectsAndNuisances) {
    Simulations all = simulations();
    const Eigen::MatrixXd rows = all.library({});
    EXPECT_THAT(paired_trials(plan.library), ElementsAre(0u, 1u));
    const std::vector<Probe> probes = probes_of(plan.library);
    ASSERT_EQ(probes.size(), 2 + plan.library.nuisances.size());
    EXPECT_EQ(probes[0].name, "force_bias");
    EXPECT_EQ(probes[1].name, "plate_tilt");
    EXPECT_EQ(probes[1].amplitudes[0], -0.015);
    EXPECT_EQ(probes[1].amplitudes[1], 0.015);
    EXPECT_EQ(probes[2].name, "modulus");
    EXPECT_EQ(probes[2].amplitudes[1], plan.library.nuisances[0].sigma);
    ASSERT_EQ(rows.rows(), 3 + 4 * static_cast<Eigen::Index>(probes.size()));
    ASSERT_EQ(rows.cols(), static_cast<Eigen::Index>(bins_of(small.common.grid).size()));
    for (const Eigen::Index row : {3, 4, 5, 6})
        EXPECT_EQ(rows(row, 0), rows((row - 3) % 2, 0)) << "the plate's force is not a contact force";
    // ln F of the plate increases by one with ln E, except for rearrangements.
    const double sigma = probes[2].amplitudes[1];
    EXPECT_GT((rows(13, 1) + rows(14, 1) - rows(11, 1) - rows(12, 1)) / 2, 0.3 * 2 * sigma);
    // The same from trials made here.
    std::vector<Trial> trials = baseline_trials(plan.library);
    const Eigen::MatrixXd baseline = observed(trials);
    for (Eigen::Index row = 0; row < 3; ++row) EXPECT_TRUE(same(baseline.row(row), rows.row(row)));
    trials.resize(2);
    for (const int k : {0, 1}) {
        for (Trial& trial : trials) trial.model.replica.effects.plate_tilt_x = k ? 0.015 : -0.015;
        const Eigen::MatrixXd tilted = observed(trials);
        for (Eigen::Index row = 0; row < 2; ++row)
            EXPECT_TRUE(same(tilted.row(row), rows.row(7 + 2 * k + row)));
    }
}

TEST_F(SmallSimulations, OfALibraryAreMadeOfEveryPacking) {
    Packing mirrored = small.packing;
    for (Vec3& position : mirrored.position) position.x() = small.model.replica.box.size_x - position.x();
    plan.library.packings.push_back({small.model, mirrored});
    plan.library.replicates = 2;
    plan.library.pairs = 1;
    plan.library.candidates = {"force_bias"};
    plan.library.nuisances.clear();
    Simulations all = simulations();
    const Eigen::MatrixXd rows = all.library({});
    EXPECT_THAT(paired_trials(plan.library), ElementsAre(0u, 2u));  // one of each packing
    ASSERT_EQ(rows.rows(), 2 * 2 + 2 * 2);
    EXPECT_FALSE(same(rows.row(0), rows.row(2)));
    EXPECT_EQ(rows(4, 0), rows(0, 0)) << "the plate's force, without contact forces";
    EXPECT_EQ(rows(5, 0), rows(2, 0));
}

TEST_F(SmallSimulations, FailuresHaveAReasonAndBelongToAnEffect) {
    plan.library.packings[0].model.replica.numerics.overlap_limit = 1e-4;
    plan.library.replicates = 2;
    plan.library.pairs = 1;
    plan.library.candidates = {"friction"};
    Simulations all = simulations();
    all.library({});
    // The zero of strain is the instrument's: its trials look at the simulations of the baseline.
    EXPECT_THAT(all.causes_of_failure(), UnorderedElementsAre(Key(""), Key("friction"), Key("modulus")));
    for (const auto& [probe, cause] : all.causes_of_failure()) EXPECT_THAT(cause, HasSubstr("overlap"));
}

TEST_F(SmallSimulations, ChangedKeysAreThoseOfTheScene) {
    const Simulations all = simulations();
    EXPECT_THAT(all.changed_keys({{"friction", 0.05}, {"force_bias", 0.1}}),
                ElementsAre("grains.friction = 0.08"));
    EXPECT_THAT(all.changed_keys({{"force_bias", 0.1}}), testing::IsEmpty());
}

}  // namespace
}  // namespace mcdem
