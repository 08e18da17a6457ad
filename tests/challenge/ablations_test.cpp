// Ablations: parts of the method are removed for evidence with a known result. Stored evidence and findings
// are read back unchanged.
#include "challenge/ablations.h"

#include <gmock/gmock.h>

#include <fstream>

#include "challenge/results.h"
#include "core/errors.h"
#include "ensemble/small_scene.h"
#include "scene/random.h"

namespace mcdem {
namespace {

constexpr int packings = 8, replicates = 4;

Eigen::VectorXd cells_where(const Grid& grid, bool (*wanted)(const Observable&)) {
    const auto cells = cells_of(grid);
    Eigen::VectorXd chosen = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(cells.size()));
    for (std::size_t k = 0; k < cells.size(); ++k)
        chosen[static_cast<Eigen::Index>(k)] =
            wanted(observables()[static_cast<std::size_t>(cells[k].observable)]);
    return chosen;
}

Signature signature(const std::string& name, const Eigen::VectorXd& linear) {
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(linear.size());
    return {name, 1, linear, zero, linear.transpose().replicate(8, 1)};
}

/// Noise of 1 between replicates and of 3 between packings. "adhesion" is visible only in observables that
/// require positions, "friction" only in the top force, "modulus" in every cell.
Evidence evidence(double adhesion, double friction, double modulus = 0) {
    Random random(7, Stream::null_draws);
    Evidence e;
    e.library.grid = {{0.004, 0.006, 0.008, 0.0098}, 0.002, 0.01};
    const auto in_positions =
        cells_where(e.library.grid, [](const Observable& o) { return o.needs == Needs::positions; });
    const auto in_top =
        cells_where(e.library.grid, [](const Observable& o) { return o.needs == Needs::plate; });
    const auto cells = in_top.size();
    const auto noise = [&](double sd) {
        return Eigen::VectorXd::NullaryExpr(cells, [&] { return sd * random.normal(); }).eval();
    };
    e.library.baseline.resize(packings * replicates, cells);
    for (int p = 0; p < packings; ++p) {
        const Eigen::VectorXd centre = noise(3);
        for (int r = 0; r < replicates; ++r) {
            e.library.packing.push_back(p);
            e.library.baseline.row(p * replicates + r) = (centre + noise(1)).transpose();
        }
    }
    const Eigen::VectorXd own = noise(3);
    e.baseline.resize(6, cells);
    for (int r = 0; r < 6; ++r) e.baseline.row(r) = (own + noise(1)).transpose();
    e.library.effects = {signature("adhesion", in_positions), signature("friction", in_top)};
    e.library.nuisances = {signature("modulus", Eigen::VectorXd::Ones(cells))};
    e.candidates = {{"adhesion", "J/m2", -20, 20}, {"friction", "", -20, 20}};
    e.nuisances = {{"modulus", "", 0.5}};
    e.observed =
        own + noise(1) + adhesion * in_positions + friction * in_top + modulus * Eigen::VectorXd::Ones(cells);
    return e;
}

const Ablation& ablation(std::string_view name) {
    return *std::ranges::find(ablations(), name, &Ablation::name);
}
Answer answer_without(std::string_view name, const Evidence& e) {
    return answer_of(ablated_findings(e, ablation(name)), Limits{});
}
const SimplerMethod& method(std::string_view name) {
    return *std::ranges::find(simpler_methods(), name, &SimplerMethod::name);
}

TEST(Ablations, WithoutConfirmationRunsSignaturesNameTheEffect) {
    const Answer answer = answer_without("without confirming runs", evidence(2, 0));
    ASSERT_TRUE(answer.names());
    EXPECT_EQ(answer.group.front(), "adhesion");
    EXPECT_FALSE(answer_without("without confirming runs", evidence(0, 0)).detected());
}

TEST(Ablations, WithoutConditionalObservablesTheirEffectIsNotDetected) {
    EXPECT_FALSE(answer_without("without conditional observables", evidence(2, 0)).detected());
    EXPECT_TRUE(answer_without("without conditional observables", evidence(0, 8)).detected());
}

TEST(Ablations, TopForceAloneDetectsItsEffect) {
    EXPECT_FALSE(answer_without("top force alone", evidence(2, 0)).detected());
    EXPECT_TRUE(answer_without("top force alone", evidence(0, 8)).detected());
}

TEST(Ablations, WithoutPairingTheScatterOfPackingsHidesTheEffect) {
    // Over packings sigma is 3: gains decrease by a factor of ten, and the mean is over eight packings. The
    // covariance from 32 rows recovers part of it; the rest varies between draws.
    const Evidence e = evidence(1.5, 0);
    const double paired = ablated_findings(e, ablation("without confirming runs")).gain.at(0);
    const double unpaired = ablated_findings(e, ablation("without pairing")).gain.at(0);
    EXPECT_LT(unpaired, 0.5 * paired);
    EXPECT_GT(paired, 20);
}

TEST(Ablations, WithoutNuisancesAShiftWithinItsPriorIsAGap) {
    const Evidence e = evidence(0, 0, 0.5);  // one sigma
    EXPECT_FALSE(answer_without("without confirming runs", e).detected());
    EXPECT_TRUE(answer_without("without nuisances", e).detected());
}

TEST(Ablations, TooLittleEvidenceFindsNothing) {
    Evidence e = evidence(5, 0);
    e.observed.setConstant(std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(answer_without("without confirming runs", e).detected());
}

TEST(SimplerMethods, RmseRankingAlwaysNames) {
    EXPECT_EQ(method("RMSE ranking").answer(evidence(3, 0)).group, std::vector<std::string>{"adhesion"});
    EXPECT_EQ(method("RMSE ranking").answer(evidence(0, 9)).group, std::vector<std::string>{"friction"});
    EXPECT_TRUE(method("RMSE ranking").answer(evidence(0, 0)).names());
}

TEST(SimplerMethods, BicNamesAnEffectOnlyIfItIsWorthItsParameter) {
    EXPECT_EQ(method("BIC").answer(evidence(3, 0)).group, std::vector<std::string>{"adhesion"});
    EXPECT_FALSE(method("BIC").answer(evidence(0, 0)).detected());
}

TEST(KeptEvidence, IsReadBackUnchanged) {
    TestFolder folder;
    Evidence e = evidence(1, 2);
    e.observed[3] = std::numeric_limits<double>::quiet_NaN();
    std::ofstream(folder.path / "e.json") << evidence_text(e);
    const Evidence back = read_evidence(folder.path / "e.json", e.library);
    EXPECT_TRUE(std::isnan(back.observed[3]));
    e.observed[3] = 0;
    Eigen::VectorXd observed = back.observed;
    observed[3] = 0;
    EXPECT_EQ(observed, e.observed);
    EXPECT_EQ(back.baseline, e.baseline);
    EXPECT_EQ(back.candidates.at(1).name, "friction");
    EXPECT_EQ(back.candidates.at(0).low, -20);
    EXPECT_EQ(back.nuisances.at(0).sigma, 0.5);
    EXPECT_EQ(back.seed, e.seed);
}

TEST(KeptEvidence, OfAnotherLibraryIsRefused) {
    TestFolder folder;
    const Evidence e = evidence(1, 2);
    std::ofstream(folder.path / "e.json") << evidence_text(e);
    Library without = e.library;
    without.effects.pop_back();
    EXPECT_THAT([&] { read_evidence(folder.path / "e.json", without); },
                testing::ThrowsMessage<InputError>(testing::HasSubstr("lacks an effect")));
    Library shorter = e.library;
    shorter.baseline.conservativeResize(shorter.baseline.rows(), shorter.baseline.cols() - 1);
    EXPECT_THAT([&] { read_evidence(folder.path / "e.json", shorter); },
                testing::ThrowsMessage<InputError>(testing::HasSubstr("other observables")));
}

TEST(KeptFindings, AreReadBackUnchanged) {
    TestFolder folder;
    const Findings f{0.004,
                     {"adhesion", "modulus"},
                     1,
                     {12.5, 3},
                     {{{0}, {0.1}, {0.02}, 12.5, 0.3, 11.0, std::nullopt, 0.8, 0.7},
                      {{0, 1}, {0.1, 0.2}, {0.02, 0.03}, 15, 0.6, {}, {}, 0.9, {}}},
                     false,
                     0.3,
                     0.2};
    std::ofstream(folder.path / "f.json") << findings_text(f);
    const Findings back = read_findings(folder.path / "f.json");
    EXPECT_EQ(findings_text(back), findings_text(f));
    EXPECT_EQ(back.proposals.at(0).confirmed_gain, 11.0);
    EXPECT_FALSE(back.proposals.at(0).confirmed_misfit_p);
    EXPECT_EQ(back.effects, 1);
    EXPECT_EQ(back.proposals.at(0).confirmed_reduction, 0.7);
    EXPECT_EQ(back.proposals.at(1).reduction, 0.9);
    EXPECT_FALSE(back.held_out);
    EXPECT_EQ(back.held_out_noise, 0.3);
    EXPECT_EQ(back.placebo, 0.2);
}

}  // namespace
}  // namespace mcdem
