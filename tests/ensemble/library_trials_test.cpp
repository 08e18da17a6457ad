// The trials of a library, and the effects that it can have.
#include "ensemble/diagnosis/library_trials.h"

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
