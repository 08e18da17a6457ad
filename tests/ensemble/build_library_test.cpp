// Libraries of tiny packings: their contents, and the runs from which they are made.
#include "ensemble/diagnosis/build_library.h"

#include <gmock/gmock.h>

#include "core/errors.h"
#include "ensemble/small_trials.h"

namespace mcdem {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;
using ::testing::UnorderedElementsAre;

TEST(BaselineTrials, HaveDifferentSeeds) {
    const SmallTrials small;
    LibraryPlan plan;
    plan.packings = {{small.model, small.packing}, {small.model, small.packing}};
    plan.replicates = 3;
    plan.jitter = 1e-5;
    plan.diameter_jitter = 2e-5;
    plan.seed = 7;
    const auto trials = baseline_trials(plan);
    const Trial finer = finer_baseline_trials(plan).front();
    EXPECT_EQ(finer.jitter, trials[0].jitter / 2);
    EXPECT_EQ(finer.model.instrument.stated.position_error,
              trials[0].model.instrument.stated.position_error / 2);
    EXPECT_EQ(finer.seed, trials[0].seed);
    ASSERT_EQ(trials.size(), 6u);
    for (std::size_t t = 0; t < 6; ++t) {
        EXPECT_EQ(trials[t].seed, 7 + 1000 * (t / 3) + t % 3);
        EXPECT_EQ(trials[t].jitter, 1e-5);
        EXPECT_EQ(trials[t].diameter_jitter, 2e-5);
        EXPECT_FALSE(trials[t].keep_recording);
    }
}

TEST(BuildLibrary, ContainsBaselineEffectsAndNuisances) {
    const SmallTrials small;
    Device device;
    LibraryPlan plan;
    plan.packings = {{small.model, small.packing}};
    plan.replicates = 3;
    plan.pairs = 2;
    plan.jitter = plan.diameter_jitter = 1e-5;
    plan.candidates = {"force_bias", "plate_tilt"};
    plan.nuisances = nuisances(small.model, {});
    const Library library = build_library(device, small.common, plan, small.store, {});
    const auto cells = static_cast<Eigen::Index>(cells_of(small.common.grid).size());
    EXPECT_EQ(library.grid.displacement, small.common.grid.displacement);
    EXPECT_EQ(library.packing, (std::vector{0, 0, 0}));
    ASSERT_EQ(library.baseline.rows(), 3);
    ASSERT_EQ(library.baseline.cols(), cells);
    ASSERT_EQ(library.effects.size(), 2u);
    EXPECT_EQ(library.effects[0].name, "force_bias");
    EXPECT_EQ(library.effects[1].name, "plate_tilt");
    EXPECT_EQ(library.effects[1].reach, 0.015);
    EXPECT_EQ(library.effects[1].pairs(), 2);
    ASSERT_EQ(library.nuisances.size(), plan.nuisances.size());
    EXPECT_EQ(library.nuisances[0].name, "modulus");
    EXPECT_EQ(library.nuisances[0].reach, plan.nuisances[0].sigma);
    EXPECT_EQ(library.provenance.at("program"), "test");

    // The plate's force is not a contact force: a bias of contact forces does not change it.
    EXPECT_EQ(library.effects[0].linear[0], 0);
    EXPECT_GT(library.nuisances[0].linear[1],
              0.3);  // ln F increases by one with ln E, except for rearrangements
    // The same signature from trials made here.
    std::vector<Trial> trials = baseline_trials(plan);
    const Eigen::MatrixXd before = observe_trials(device, small.common, trials, small.store, {});
    EXPECT_TRUE(same(before.row(2), library.baseline.row(2)));
    trials.resize(2);
    Eigen::MatrixXd differences[2];
    for (int k = 0; k < 2; ++k) {
        for (Trial& trial : trials) trial.model.replica.effects.plate_tilt_x = k ? 0.015 : -0.015;
        differences[k] = observe_trials(device, small.common, trials, small.store, {}) - before.topRows(2);
    }
    const Signature tilt = learn_signature("plate_tilt", -0.015, 0.015, differences[0], differences[1]);
    EXPECT_TRUE(same(tilt.linear, library.effects[1].linear));
    EXPECT_TRUE(same(tilt.curvature, library.effects[1].curvature));
}

TEST(BuildLibrary, UsesSeveralPackings) {
    const SmallTrials small;
    Device device;
    LibraryPlan plan;
    Packing mirrored = small.packing;
    for (Vec3& position : mirrored.position) position.x() = small.model.replica.box.size_x - position.x();
    plan.packings = {{small.model, small.packing}, {small.model, mirrored}};
    plan.replicates = 2;
    plan.pairs = 1;
    plan.candidates = {"force_bias"};
    const Library library = build_library(device, small.common, plan, small.store, {});
    EXPECT_EQ(library.packing, (std::vector{0, 0, 1, 1}));
    EXPECT_EQ(library.effects[0].pairs(), 2);  // one of each packing
    EXPECT_TRUE(library.nuisances.empty());
    EXPECT_FALSE(same(library.baseline.row(0), library.baseline.row(2)));
}

TEST(BuildLibrary, FailuresHaveAReasonAndBelongToAnEffect) {
    const SmallTrials small;
    Device device;
    LibraryPlan plan;
    plan.packings = {{small.model, small.packing}};
    plan.packings[0].model.replica.numerics.overlap_limit = 1e-4;
    plan.replicates = 2;
    plan.pairs = 1;
    plan.candidates = {"friction"};
    plan.nuisances = nuisances(small.model, {});
    std::vector<std::string> failed;
    TrialOptions options;
    options.on_failure = [&](std::size_t trial, const Failure& failure) {
        failed.push_back(probe_of_trial(plan, trial));
        EXPECT_THAT(failure.cause, HasSubstr("overlap"));
    };
    build_library(device, small.common, plan, small.store, options);
    // The zero of strain is the instrument's: its trials look at the simulations of the baseline.
    EXPECT_THAT(failed, UnorderedElementsAre("", "", "friction", "friction", "modulus", "modulus"));
}

TEST(ChooseCandidates, AllThatTheModelAllows) {
    Model model = SmallTrials().model;
    model.replica.contact.model = ContactModel::independent;
    const CandidateChoice all = choose_candidates(model, {});
    EXPECT_EQ(all.chosen.size() + all.hindered.size(), effects().size());
    EXPECT_THAT(all.chosen, AllOf(Contains("cross_contact"), Not(Contains("bulge_contacts"))));
    EXPECT_THAT(all.hindered,
                ElementsAre("bulge_contacts: independent contacts have no surface displacements",
                            StartsWith("finite_strain: only")));
    const CandidateChoice some = choose_candidates(model, {"adhesion", "bulge_contacts"});
    EXPECT_THAT(some.chosen, ElementsAre("adhesion"));
    EXPECT_EQ(some.hindered.size(), 1u);
}

TEST(ChooseCandidates, UnknownEffectsAreNamed) {
    const Model model = SmallTrials().model;
    EXPECT_THAT(
        [&] {
            choose_candidates(model, {"adhesion", "phlogiston", "ether"});
        },
        ThrowsMessage<InputError>(AllOf(HasSubstr("phlogiston is not an effect; there are cross_contact"),
                                        HasSubstr("ether is not an effect"))));
}

}  // namespace
}  // namespace mcdem
