// Proposed explanations of a planted gap, and their change by confirmation runs.
#include "diagnose/infer/proposals.h"

#include <gmock/gmock.h>

#include <cmath>

#include "diagnose/synthetic_evidence.h"

namespace mcdem::proposals {
namespace {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

constexpr int replicates = 32;
const Eigen::VectorXd at_priors = Eigen::VectorXd::Zero(1);

/// A gap from these `amplitudes` of the four effects.
struct Case {
    explicit Case(const std::vector<double>& amplitudes, std::uint64_t seed = 1)
        : world(4, seed), evidence(make(amplitudes)), data(gap_data(evidence)) {}

    Evidence make(const std::vector<double>& amplitudes) {
        Evidence e = world.evidence(1, replicates);
        for (const char* name : {"adhesion", "friction", "plasticity", "plate_tilt"})
            world.add_effect(e, name, world.pattern(1));
        world.add_nuisance(e, "modulus", world.pattern(0.5), 1);
        for (std::size_t k = 0; k < amplitudes.size(); ++k)
            e.observed += amplitudes[k] * e.library.effects[k].linear;
        return e;
    }
    std::vector<Proposal> proposals() const { return propose(space, data, null, statistics, replicates); }

    SyntheticWorld world;
    Evidence evidence;
    GapData data;
    GapSpace space{data.noise, replicates, data.cells, data.free};
    NullDistribution null{data, replicates, 1};
    GapStatistics statistics = gap_statistics(space, data, data.gap);
};

TEST(Proposals, OneEffectExplainsTheGap) {
    const Case c({0, 4});
    const auto list = c.proposals();
    ASSERT_FALSE(list.empty());
    EXPECT_THAT(list[0].candidates, ElementsAre(1));
    EXPECT_NEAR(list[0].amplitudes[0], 4, 4 * list[0].errors[0]);
    EXPECT_EQ(list[0].gain, c.statistics.directed);
    EXPECT_GT(list[0].misfit_p, 0.01);
    for (const Proposal& p : list) EXPECT_EQ(p.candidates.size(), 1u);
}

TEST(Proposals, TwoEffectsExplainTheGapTogether) {
    const Case c({0, 4, 0, -3});
    const auto list = c.proposals();
    const Proposal& pair = list.back();
    ASSERT_THAT(pair.candidates, UnorderedElementsAre(1, 3));
    const std::size_t first = pair.candidates[0] == 1 ? 0 : 1;
    EXPECT_NEAR(pair.amplitudes[first], 4, 4 * pair.errors[first]);
    EXPECT_NEAR(pair.amplitudes[1 - first], -3, 4 * pair.errors[1 - first]);
    EXPECT_GT(pair.misfit_p, 0.01);
    EXPECT_LT(list[0].misfit_p, 0.003);
    const Eigen::VectorXd left = c.data.gap - explained_by(pair, c.data);
    EXPECT_NEAR(pair.gain, 0.5 * (c.statistics.omnibus - c.space.whiten(left).squaredNorm()),
                1e-6 * pair.gain);
}

// The two effects cancel most of each other, so a third effect with the signature of the remainder is the
// best single one.
TEST(Proposals, TwoEffectsNeitherOfWhichIsBestAlone) {
    Case c({});
    const Eigen::VectorXd large = c.world.pattern(3), small = c.world.pattern(0.5),
                          decoy = c.world.pattern(0.2);
    auto& effects = c.evidence.library.effects;
    effects[1].linear = large;
    effects[3].linear = -large + small;
    effects[0].linear = small + decoy;
    const Eigen::VectorXd gap = 8 * (effects[1].linear + effects[3].linear);
    const GapStatistics statistics = [&] {
        c.data.gap = gap;
        return gap_statistics(c.space, c.data, gap);
    }();
    ASSERT_EQ(statistics.best, 0u);
    const auto list = propose(c.space, c.data, c.null, statistics, replicates);
    ASSERT_THAT(list.back().candidates, UnorderedElementsAre(1, 3));
    EXPECT_NEAR(list.back().amplitudes[0], 8, 4 * list.back().errors[0]);
    EXPECT_NEAR(list.back().amplitudes[1], 8, 4 * list.back().errors[1]);
}

/// Proposals for a gap in the direction of the first effect. The gains of `others` are lower by 1, 2, ..,
/// that of the nuisance beyond its prior by `behind`.
std::vector<std::size_t> singles_with_nuisance(Case& c, double behind) {
    GapStatistics statistics = c.statistics;
    for (std::size_t k = 0; k < statistics.fits.size(); ++k) {
        statistics.fits[k].score = 50 - static_cast<double>(k);
        statistics.fits[k].amplitude = 1;
    }
    statistics.fits.back().score = 50 - behind;
    statistics.directed = 50;
    std::vector<std::size_t> list;
    for (const Proposal& p : propose(c.space, c.data, c.null, statistics, replicates))
        if (p.candidates.size() == 1) list.push_back(p.candidates[0]);
    return list;
}

TEST(Proposals, ANuisanceWithGainIsAlwaysConfirmed) {
    Case c({4});
    ASSERT_EQ(c.data.candidates.size(), 5u);
    EXPECT_THAT(singles_with_nuisance(c, 10), ElementsAre(0, 1, 2, 4));
    EXPECT_THAT(singles_with_nuisance(c, 49), ElementsAre(0, 1, 2, 4));
    EXPECT_THAT(singles_with_nuisance(c, 51), ElementsAre(0, 1, 2));  // without gain
    EXPECT_THAT(singles_with_nuisance(c, 0.5), ElementsAre(0, 4, 1));
}

TEST(Proposals, ExplanationBySignaturesIsFound) {
    const Case c({});
    Proposal p;
    p.candidates = {0, 2};
    p.amplitudes = {1.5, -2};
    const Eigen::VectorXd sum =
        1.5 * c.evidence.library.effects[0].linear - 2 * c.evidence.library.effects[2].linear;
    EXPECT_LT((explained_by(p, c.data) - sum).norm(), 1e-12);
}

TEST(Proposals, EffectsWithoutGainAreNotProposed) {
    Case c({});
    GapStatistics nothing = c.statistics;
    for (EffectFit& fit : nothing.fits) fit = {};
    nothing.directed = 0;
    EXPECT_TRUE(propose(c.space, c.data, c.null, nothing, replicates).empty());
}

Eigen::MatrixXd runs(Case& c, const Eigen::VectorXd& shift, int number) {
    Eigen::MatrixXd rows(number, c.data.mean.size());
    const Eigen::VectorXd centre = c.data.mean + shift;
    for (int r = 0; r < number; ++r) rows.row(r) = (centre + c.world.noise()).transpose();
    return rows;
}

TEST(Confirmation, RunsThatAgreeWithTheData) {
    Case c({0, 4}, 2);
    Proposal p = c.proposals().at(0);
    const auto step = confirm(p, c.data, c.null, {}, 0.001, c.evidence.observed, at_priors,
                              runs(c, 4 * c.evidence.library.effects[1].linear, 16));
    ASSERT_TRUE(step);
    EXPECT_EQ(step->size(), 2);  // the modulus, then the amplitude
    EXPECT_GT(*p.confirmed_misfit_p, 0.01);
    EXPECT_NEAR(*p.confirmed_gain, p.gain, 0.25 * p.gain);
}

TEST(Confirmation, RunsThatDoNotAgreeWithTheData) {
    Case c({0, 4}, 2);
    Proposal p = c.proposals().at(0);
    confirm(p, c.data, c.null, {}, 0.001, c.evidence.observed, at_priors,
            runs(c, 4 * c.evidence.library.effects[2].linear, 16));
    EXPECT_LT(*p.confirmed_misfit_p, 1e-3);
    EXPECT_LT(*p.confirmed_gain, 0.6 * p.gain);
}

// The runs explain the data equally well; the nuisance shifts that they require are penalised.
TEST(Confirmation, NuisanceShiftsArePenalisedByTheirPrior) {
    Case c({0, 4}, 2);
    Proposal p = c.proposals().at(0), far = p;
    const Eigen::MatrixXd meet = runs(c, 4 * c.evidence.library.effects[1].linear, 16);
    confirm(p, c.data, c.null, {}, 0.001, c.evidence.observed, at_priors, meet);
    confirm(far, c.data, c.null, {}, 0.001, c.evidence.observed, Eigen::VectorXd::Constant(1, 3),
            meet);  // three sigmas
    EXPECT_NEAR(*p.confirmed_gain - *far.confirmed_gain, 4.5, 1e-9);
}

// An effect with a large scatter reduces chi-square. It is penalised if the data do not show this scatter.
TEST(Confirmation, ScatterThatTheDataDoNotShowIsPenalised) {
    Case c({});
    Signature& scattering = c.evidence.library.effects[1];
    scattering.slopes =
        std::sqrt(0.5) * Eigen::Vector2d(1, -1) * Eigen::RowVectorXd::Ones(scattering.linear.size());
    ASSERT_NEAR(scattering.spread()[0], 1, 1e-12);
    Proposal p;
    p.candidates = {1};
    p.amplitudes = {5};
    p.errors = {0.1};
    confirm(p, c.data, c.null, {}, 0.001, c.evidence.observed, at_priors,
            runs(c, Eigen::VectorXd::Zero(c.data.mean.size()), 16));
    EXPECT_GT(*p.confirmed_misfit_p, 0.5);
    EXPECT_LT(*p.confirmed_gain, -10);
}

TEST(Confirmation, StepIsTheErrorOfTheAmplitude) {
    Case c({0, 4}, 2);
    Proposal p = c.proposals().at(0);
    const auto step = confirm(p, c.data, c.null, {}, 0.001, c.evidence.observed, at_priors,
                              runs(c, 3 * c.evidence.library.effects[1].linear, 200));
    ASSERT_TRUE(step);
    EXPECT_NEAR((*step)[1], 1, 0.6);  // one sigma of the amplitude is 0.2, and the prior has some influence
}

TEST(Confirmation, FailedRunsAreExcluded) {
    Case c({0, 4}, 2);
    Proposal p = c.proposals().at(0), without = p;
    Eigen::MatrixXd failed = runs(c, 4 * c.evidence.library.effects[1].linear, 4);
    const Eigen::MatrixXd whole = failed(std::vector{0, 1, 3}, Eigen::all);
    failed(2, c.data.cells.back()) = not_available;
    ASSERT_TRUE(confirm(p, c.data, c.null, {}, 0.001, c.evidence.observed, at_priors, failed));
    ASSERT_TRUE(confirm(without, c.data, c.null, {}, 0.001, c.evidence.observed, at_priors, whole));
    EXPECT_EQ(*p.confirmed_gain, *without.confirmed_gain);
    EXPECT_EQ(*p.confirmed_misfit_p, *without.confirmed_misfit_p);
}

TEST(Confirmation, RequiresMoreThanOneRun) {
    Case c({0, 4}, 2);
    Proposal p = c.proposals().at(0);
    Eigen::MatrixXd failed = runs(c, Eigen::VectorXd::Zero(c.data.mean.size()), 4);
    failed.bottomRows(3).setConstant(not_available);
    EXPECT_FALSE(confirm(p, c.data, c.null, {}, 0.001, c.evidence.observed, at_priors, failed));
    EXPECT_FALSE(p.confirmed_gain);
}

}  // namespace
}  // namespace mcdem::proposals
