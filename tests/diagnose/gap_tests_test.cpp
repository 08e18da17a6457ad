// False alarms and power of the two tests, with random synthetic experiments.
#include "diagnose/infer/gap_tests.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "diagnose/synthetic_evidence.h"

namespace mcdem {
namespace {

constexpr int experiments = 200;

struct Shares {
    double omnibus = 0, directed = 0;  ///< fraction of experiments with p < 0.05
};

/// Every experiment has evidence and a library of its own. `planted`: amplitude of the candidate.
Shares alarms(int packings, int replicates, double planted, int observables_known = 4) {
    Shares shares;
    for (int k = 0; k < experiments; ++k) {
        SyntheticWorld world(observables_known, 100 + static_cast<std::uint64_t>(k));
        Evidence evidence = world.evidence(packings, replicates);
        world.add_effect(evidence, "adhesion", world.pattern(0.5));
        world.add_effect(evidence, "friction", world.pattern(0.5));
        world.add_nuisance(evidence, "modulus", world.pattern(1), 2);
        evidence.observed += planted * evidence.library.effects[0].linear;
        evidence.observed += 2 * world.random().normal() * evidence.library.nuisances[0].linear;
        const GapData data = gap_data(evidence);
        const GapSpace space(data.noise, replicates, data.cells, data.free);
        const NullDistribution null(data, replicates, 1);
        const GapStatistics s = gap_statistics(space, data, data.gap);
        shares.omnibus += null.p_value(&GapStatistics::omnibus, s.omnibus) < 0.05 ? 1.0 / experiments : 0;
        shares.directed += null.p_value(&GapStatistics::directed, s.directed) < 0.05 ? 1.0 / experiments : 0;
    }
    return shares;
}

// Of 200 experiments 5 % +- 1.5 % give a false alarm; the null distribution from 32 replicates adds as much
// again.
void expect_about_one_in_twenty(const Shares& shares) {
    EXPECT_GE(shares.omnibus, 0.005);
    EXPECT_LE(shares.omnibus, 0.12);
    EXPECT_GE(shares.directed, 0.005);
    EXPECT_LE(shares.directed, 0.12);
}

TEST(GapTests, FalseAlarmsWithOnePacking) { expect_about_one_in_twenty(alarms(1, 32, 0)); }

// Two replicates of a packing are mirror images of each other about their mean. The null distribution must
// leave out both together.
TEST(GapTests, FalseAlarmsWithManyPackings) { expect_about_one_in_twenty(alarms(16, 2, 0)); }

/// 400 experiments without an effect, with the smallest number of replicates and the number of cells of a
/// complete experiment: fractions with p below 0.01, 0.05, 0.2 and 0.5.
TEST(GapTests, PIsUniformWithTheFewestReplicates) {
    constexpr int drawn = 400, replicates = 8;
    const double levels[] = {0.01, 0.05, 0.2, 0.5};
    double omnibus[4]{}, directed[4]{};
    for (int k = 0; k < drawn; ++k) {
        SyntheticWorld world(20, 700 + static_cast<std::uint64_t>(k));
        Evidence evidence = world.evidence(1, replicates);
        world.add_effect(evidence, "adhesion", world.pattern(0.5));
        world.add_effect(evidence, "friction", world.pattern(0.5));
        world.add_nuisance(evidence, "modulus", world.pattern(1), 2);
        evidence.observed += 2 * world.random().normal() * evidence.library.nuisances[0].linear;
        const GapData data = gap_data(evidence);
        const GapSpace space(data.noise, replicates, data.cells, data.free);
        const NullDistribution null(data, replicates, 1);
        const GapStatistics s = gap_statistics(space, data, data.gap);
        for (int l = 0; l < 4; ++l) {
            omnibus[l] += null.p_value(&GapStatistics::omnibus, s.omnibus) < levels[l] ? 1.0 / drawn : 0;
            directed[l] += null.p_value(&GapStatistics::directed, s.directed) < levels[l] ? 1.0 / drawn : 0;
        }
    }
    for (int l = 0; l < 4; ++l) {
        const double error = std::sqrt(levels[l] * (1 - levels[l]) / drawn);
        EXPECT_NEAR(omnibus[l], levels[l], 3.5 * error) << levels[l];
        EXPECT_NEAR(directed[l], levels[l], 3.5 * error) << levels[l];
    }
}

/// An experiment with eight replicates of its packing, and a library of twelve other packings with four
/// replicates each. The scatter of a packing is one times a log-normal factor; `spread` is the standard
/// deviation of its logarithm. `own`: factor of the experiment's packing, or 0 to draw it like the others.
Evidence other_packings(SyntheticWorld& world, double spread, double own, double planted = 0) {
    constexpr int packings = 12, replicates = 4, own_replicates = 8;
    const auto factor = [&] { return std::exp(spread * world.random().normal()); };
    Evidence evidence;
    evidence.library_is_own = false;
    evidence.library.grid = synthetic_grid;
    const Eigen::Index cells = world.noise().size();
    evidence.library.baseline.resize(packings * replicates, cells);
    for (int p = 0; p < packings; ++p) {
        const Eigen::VectorXd centre = world.noise(3);
        const double scale = factor();
        for (int r = 0; r < replicates; ++r) {
            evidence.library.baseline.row(p * replicates + r) = (centre + world.noise(scale)).transpose();
            evidence.library.packing.push_back(p);
        }
    }
    const Eigen::VectorXd centre = world.noise(3);
    const double scale = own > 0 ? own : factor();
    evidence.baseline.resize(own_replicates, cells);
    for (int r = 0; r < own_replicates; ++r)
        evidence.baseline.row(r) = (centre + world.noise(scale)).transpose();
    evidence.observed = centre + world.noise(scale);
    world.add_effect(evidence, "adhesion", world.pattern(0.5));
    world.add_effect(evidence, "friction", world.pattern(0.5));
    world.add_nuisance(evidence, "modulus", world.pattern(1), 2);
    evidence.observed += planted * evidence.library.effects[0].linear;
    evidence.observed += 2 * world.random().normal() * evidence.library.nuisances[0].linear;
    return evidence;
}

/// Fractions of 100 such experiments with a gap at p < 0.01 and p < 0.05 (smaller p of the two tests,
/// doubled).
std::array<double, 2> gaps_claimed(double spread, double own, double planted = 0) {
    constexpr int drawn = 100;
    std::array<double, 2> claimed{};
    for (int k = 0; k < drawn; ++k) {
        SyntheticWorld world(20, 900 + static_cast<std::uint64_t>(k));
        const Evidence evidence = other_packings(world, spread, own, planted);
        const GapData data = gap_data(evidence);
        const int replicates = static_cast<int>(evidence.baseline.rows());
        const GapSpace space(data.noise, replicates, data.cells, data.free);
        const NullDistribution null(data, replicates, 1);
        const GapStatistics s = gap_statistics(space, data, data.gap);
        const double p = 2 * std::min(null.p_value(&GapStatistics::omnibus, s.omnibus),
                                      null.p_value(&GapStatistics::directed, s.directed));
        claimed[0] += p < 0.01 ? 1.0 / drawn : 0;
        claimed[1] += p < 0.05 ? 1.0 / drawn : 0;
    }
    return claimed;
}

// Three standard errors above the nominal levels.
TEST(GapTests, FalseAlarmsOfPackingsThatScatterDifferently) {
    const auto [one, five] = gaps_claimed(0.3, 0);
    EXPECT_LE(one, 0.04);
    EXPECT_LE(five, 0.115);
}

TEST(GapTests, NoFalseAlarmsOfAPackingThatScattersMoreThanTheLibrary) {
    EXPECT_LE(gaps_claimed(0.3, 1.8)[0], 0.04);
}

TEST(GapTests, PowerForAPackingThatScattersLessThanTheLibrary) {
    EXPECT_GE(gaps_claimed(0.3, 0.6, 1.2)[0], 0.9);
}

TEST(GapTests, PowerForAPlantedEffect) {
    // Amplitude 2.5 of a signature of 0.5 in each of 32 cells with noise 1: about 6 sigma without
    // correlations.
    const Shares shares = alarms(1, 32, 2.5);
    EXPECT_GT(shares.directed, 0.9);
    EXPECT_GT(shares.omnibus, 0.3);
}

TEST(GapTests, StatisticsOfOneGapAreCorrect) {
    SyntheticWorld world(3, 1);
    Evidence evidence = world.evidence(1, 30);
    world.add_effect(evidence, "adhesion", world.pattern(0.5));
    world.add_effect(evidence, "friction", world.pattern(0.5));
    world.add_nuisance(evidence, "modulus", world.pattern(1), 2);
    const GapData data = gap_data(evidence);
    const GapSpace space(data.noise, 30, data.cells, data.free);
    const Eigen::VectorXd gap =
        data.gap + 4 * evidence.library.effects[1].linear + 3 * evidence.library.nuisances[0].linear;
    const GapStatistics s = gap_statistics(space, data, gap);
    ASSERT_EQ(s.fits.size(), 3u);  // the modulus beyond its prior is also a candidate
    EXPECT_EQ(s.best, 1u);
    EXPECT_EQ(data.name(s.best), "friction");
    EXPECT_EQ(data.effects, 2);
    EXPECT_EQ(data.name(2), "modulus");
    EXPECT_EQ(s.directed, s.fits[1].score);
    EXPECT_NEAR(s.omnibus, space.whiten(gap).squaredNorm(), 1e-9 * s.omnibus);
    const Eigen::VectorXd left = gap - s.fits[1].amplitude * evidence.library.effects[1].linear;
    EXPECT_NEAR(s.remainder, space.whiten(left).squaredNorm(), 1e-6 * s.remainder);
    EXPECT_EQ(s.pattern_left,
              highest_pattern(space, gap - s.fits[1].amplitude * evidence.library.effects[1].linear));
    double refitted = 0;
    const double shift = space.fit_nuisances(gap)[0];
    EXPECT_NEAR(shift, 3, 1.5);
    for (std::size_t k = 0; k < data.cells.size(); ++k) {
        const double sigma = space.sigma()[static_cast<Eigen::Index>(k)], value = gap[data.cells[k]];
        refitted = std::max(
            refitted, std::abs(value - shift * evidence.library.nuisances[0].linear[data.cells[k]]) / sigma);
    }
    EXPECT_NEAR(s.highest_refitted, refitted, 1e-12);
}

double correlated_size(const Eigen::VectorXd& weights) {  // of the noise of SyntheticWorld
    double square = 0;
    for (Eigen::Index i = 0; i < weights.size(); ++i)
        for (Eigen::Index j = 0; j < weights.size(); ++j)
            square += weights[i] * weights[j] * std::pow(0.5, std::abs(i - j));
    return std::sqrt(square);
}

TEST(GapTests, PatternsOfOneObservableAreDetected) {
    SyntheticWorld world(3, 5);
    const Evidence evidence = world.evidence(1, 2000, 0);
    const GapData data = gap_data(evidence);
    const GapSpace space(data.noise, 0, data.cells, {});
    // In the plate's order: the first four while it moves down; the last four, listed by displacement, while
    // it moves up.
    Eigen::VectorXd trend{{-3.5, -2.5, -1.5, -0.5, 3.5, 2.5, 1.5, 0.5}};
    const auto in_second_observable = [&](const Eigen::VectorXd& values) {
        Eigen::VectorXd gap = Eigen::VectorXd::Zero(data.mean.size());
        gap.segment(8, 8) = values;
        return gap;
    };
    // 2000 replicates determine variances to 3 %; the smallest correlations are removed by shrinkage.
    EXPECT_NEAR(highest_pattern(space, in_second_observable(trend)),
                trend.squaredNorm() / correlated_size(trend),
                0.06 * trend.squaredNorm() / correlated_size(trend));
    const Eigen::VectorXd even = Eigen::VectorXd::Constant(8, 1);
    EXPECT_NEAR(highest_pattern(space, in_second_observable(even)), 8 / correlated_size(even),
                0.06 * 8 / correlated_size(even));
    Eigen::VectorXd one = Eigen::VectorXd::Zero(8);
    one[2] = 7;
    EXPECT_NEAR(highest_pattern(space, in_second_observable(one)), 7, 0.06 * 7);
}

TEST(GapTests, MisfitDetectsAPatternThatTheSumDoesNotShow) {
    constexpr int tries = 100;
    int even = 0, thin = 0;
    for (int k = 0; k < tries; ++k) {
        SyntheticWorld world(20, 300 + static_cast<std::uint64_t>(k));
        const Evidence evidence = world.evidence(1, 32);
        const GapData data = gap_data(evidence);
        const GapSpace space(data.noise, 32, data.cells, {});
        const NullDistribution null(data, 32, 1);
        even += null.misfit_p(space, data.gap) < 0.05;
        Eigen::VectorXd left = data.gap;
        left.segment(8, 8).array() += 3;  // one of twenty observables: chi-square 160 +- 18, plus 24
        thin += null.misfit_p(space, left) < 0.05;
    }
    EXPECT_LE(even, 14) << "5 +- 2.2 of them, and the null's own error";
    EXPECT_GE(thin, 70);
}

TEST(NullDistribution, QuantileIsTheInverseOfP) {
    SyntheticWorld world(3, 2);
    Evidence evidence = world.evidence(1, 24);
    world.add_effect(evidence, "adhesion", world.pattern(0.5));
    world.add_nuisance(evidence, "modulus", world.pattern(1), 2);
    const GapData data = gap_data(evidence);
    const NullDistribution null(data, 24, 1);
    ASSERT_EQ(null.draws().size(), 1u);
    const std::vector<GapStatistics>& draws = null.draws().begin()->second;
    EXPECT_EQ(draws.size(), 3 * 24u);
    for (const double p : {0.5, 0.05, 0.001})
        EXPECT_NEAR(null.p_value(&GapStatistics::highest_refitted,
                                 null.quantile(&GapStatistics::highest_refitted, p)),
                    p, 1e-9);
    EXPECT_EQ(null.p_value(&GapStatistics::directed, 0), 1);
    // Equal numbers of draws above and below the median: 72 draws, 4 sigma.
    const double median = null.quantile(&GapStatistics::omnibus, 0.5);
    EXPECT_NEAR(std::ranges::count_if(draws, [&](const GapStatistics& s) { return s.omnibus > median; }), 36,
                17);
}

TEST(NullDistribution, DependsOnlyOnItsSeed) {
    SyntheticWorld world(2, 3);
    Evidence evidence = world.evidence(1, 16);
    world.add_nuisance(evidence, "modulus", world.pattern(1), 2);
    const GapData data = gap_data(evidence);
    const auto p = [&](std::uint64_t seed) {
        return NullDistribution(data, 16, seed).p_value(&GapStatistics::highest_refitted, 3);
    };
    EXPECT_EQ(p(1), p(1));
    EXPECT_NE(p(1), p(2));
}

TEST(Evidence, FoldsDoNotSplitPackings) {
    SyntheticWorld world(1, 4);
    Evidence evidence = world.evidence(9, 3);
    const GapData data = gap_data(evidence);
    for (std::size_t r = 0; r < 27; ++r) EXPECT_EQ(data.fold[r], static_cast<int>(r / 3) % 8);
    Evidence single = world.evidence(1, 12);
    const GapData alone = gap_data(single);
    for (std::size_t r = 0; r < 12; ++r) EXPECT_EQ(alone.fold[r], static_cast<int>(r) % 8);
}

TEST(Evidence, OwnReplicatesJoinTheNoiseOfALibraryOfOtherPackings) {
    SyntheticWorld world(20, 5);
    Evidence evidence = other_packings(world, 0.3, 0);
    const GapData data = gap_data(evidence);
    ASSERT_EQ(data.noise.rows(), 48 + 8);
    const Eigen::RowVectorXd mean = evidence.baseline.colwise().mean();
    for (int r = 0; r < 8; ++r) {
        EXPECT_EQ(data.group[48u + static_cast<std::size_t>(r)], own_packing);
        EXPECT_EQ(data.fold[48u + static_cast<std::size_t>(r)], 8 + r);
        EXPECT_NEAR(data.noise(48 + r, 3), (evidence.baseline(r, 3) - mean[3]) * std::sqrt(8 / 7.0), 1e-12);
    }
    evidence.library_is_own = true;
    EXPECT_EQ(gap_data(evidence).noise.rows(), 48);
    evidence.library_is_own = false;
    for (int& packing : evidence.library.packing)
        packing %= 7;  // the experiment's own packing may be among them
    EXPECT_EQ(gap_data(evidence).noise.rows(), 48);
    for (std::size_t r = 0; r < 48; ++r) evidence.library.packing[r] = static_cast<int>(r / 4);
    evidence.baseline.conservativeResize(3, Eigen::NoChange);  // too few to be used
    EXPECT_EQ(gap_data(evidence).noise.rows(), 48);
}

TEST(Evidence, GapIsObservedMinusTheBaselinesMean) {
    SyntheticWorld world(1, 5);
    Evidence evidence = world.evidence(2, 3);
    evidence.baseline(1, 4) = not_available;
    const GapData data = gap_data(evidence);
    EXPECT_NEAR(data.gap[0], evidence.observed[0] - evidence.baseline.col(0).mean(), 1e-12);
    EXPECT_NEAR(data.gap[4], evidence.observed[4] - 0.5 * (evidence.baseline(0, 4) + evidence.baseline(2, 4)),
                1e-12);
    EXPECT_EQ(data.cells, (CellChoice{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST(Evidence, EveryNameRequiresASignature) {
    SyntheticWorld world(1, 6);
    Evidence evidence = world.evidence(1, 8);
    evidence.candidates.push_back({"adhesion", "", 0, 1});
    EXPECT_THROW(gap_data(evidence), std::logic_error);
}

}  // namespace
}  // namespace mcdem
