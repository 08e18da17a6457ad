#include "report/diagnosis/diagnosis_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "report/diagnosis_samples.h"
#include "report/verdict_line.h"

namespace mcdem {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class EveryVerdict : public testing::TestWithParam<Verdict> {};
INSTANTIATE_TEST_SUITE_P(DiagnosisText, EveryVerdict, testing::ValuesIn(samples::all_verdicts));

TEST_P(EveryVerdict, has_six_sentences) {
    for (const auto& d :
         {samples::diagnosis(GetParam()), samples::with_texts(samples::diagnosis(GetParam()), "a\nb\r")}) {
        const auto text = diagnosis_text(d);
        EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 6) << text;
        for (const auto& [about, says] : verdict_lines(d)) {
            EXPECT_TRUE(says.ends_with('.') && !says.ends_with("..")) << says;
            EXPECT_EQ(says.find_first_of("\n\r"), std::string::npos) << says;
        }
        EXPECT_TRUE(verdict_sentence(d).ends_with('.')) << verdict_sentence(d);
    }
}

TEST_P(EveryVerdict, does_not_claim_proof) {
    const auto d = samples::diagnosis(GetParam());
    const auto text = diagnosis_text(d) + verdict_sentence(d);
    for (const char* claim : {"caused by", "because of", "is due to", "proves", "is proven"})
        EXPECT_THAT(text, Not(HasSubstr(claim)));
    const bool names_something = GetParam() != Verdict::no_gap && GetParam() != Verdict::unknown_effect;
    if (names_something) {
        EXPECT_THAT(line(d, "Which"), StartsWith("consistent with "));
        EXPECT_THAT(verdict_sentence(d), HasSubstr("consistent with"));
    }
}

TEST_P(EveryVerdict, works_without_optional_parts) {
    Diagnosis d;
    d.verdict = GetParam();
    EXPECT_EQ(std::ranges::count(diagnosis_text(d), '\n'), 6);
    EXPECT_FALSE(verdict_sentence(d).empty());
}

// The main cause may be a parameter: nothing before it, and nothing that hides it.
TEST(DiagnosisText, parameters_far_from_what_is_stated_are_the_first_line) {
    for (const Verdict verdict : samples::all_verdicts) {
        auto d = samples::diagnosis(verdict);
        const auto headline = verdict_headline(d), sentence = verdict_sentence(d);
        if (d.explanation) d.explanation->leaves_more_than_noise = false;
        d.check_first = {{"modulus", std::log(1.81), 0.02, 0.05, "relative", true},
                         {"strain_offset", -7e-4, 6e-5, 2e-4, "m", false}};
        const auto check =
            "check what is stated: modulus of the grains must be 81.0 ± 3.6 % higher than stated to fit (at "
            "least 12 sigma) and zero of the displacement must be 0.700 ± 0.060 mm lower than stated to fit "
            "(3.5 sigma); all that follows assumes these shifts.";
        EXPECT_THAT(diagnosis_text(d), StartsWith("First:   " + std::string(check) + "\nGap:"));
        EXPECT_EQ(verdict_sentence(d), "C" + std::string(check).substr(1) + " " + sentence);
        EXPECT_EQ(verdict_headline(d),
                  "Check first: modulus of the grains (at least 12 sigma) and 1 more. " + headline);
        if (d.explanation) {
            EXPECT_THAT(line(d, "How far"),
                        HasSubstr("cannot be distinguished from noise, with the shifts of "
                                  "parameters under First"));
        }
    }
}

TEST(DiagnosisText, bins_without_a_value_are_said) {
    auto d = samples::diagnosis(Verdict::effect);
    EXPECT_THAT(
        line(d, "Limits"),
        HasSubstr("; friction between grains has no value in 4 of 8 bins (50 %), whose gap counts as not "
                  "explained by it; modulus of the grains has no value in 1 of 9 bins (11 %), which are "
                  "not compared"));
    d.missing_bins = {{"adhesion", 4, 8, false}, {"plasticity", 4, 8, false}, {"", 2, 10, true}};
    EXPECT_THAT(
        line(d, "Limits"),
        HasSubstr("; adhesion and plasticity have no value in 4 of 8 bins (50 %), whose gap counts as not "
                  "explained by it; some runs of the scene as it stands have no value in 2 of 10 bins"));
}

TEST(DiagnosisText, no_gap_lists_the_detection_limits) {
    const auto d = samples::diagnosis(Verdict::no_gap);
    EXPECT_THAT(line(d, "Gap"), AllOf(StartsWith("none"), HasSubstr("p = 0.44")));
    EXPECT_THAT(line(d, "Limits"), AllOf(HasSubstr("adhesion from 0.08 mJ/m²"), HasSubstr("and 11 more"),
                                         HasSubstr("never show rolling resistance and bias of positions")));
}

TEST(DiagnosisText, a_difference_at_one_displacement_is_said_to_be_one) {
    auto d = samples::diagnosis(Verdict::no_gap);
    d.p_omnibus = 1e-4;
    d.p_directed = 0.2;
    d.p_value = 0.3;
    EXPECT_THAT(line(d, "Gap"),
                HasSubstr("they differ at one displacement only, where grains may have rearranged"));
    d.p_value = 2e-4;
    EXPECT_THAT(line(d, "Gap"), HasSubstr("noise alone gives differences like these"));
}

TEST(DiagnosisText, no_gap_starts_with_the_limits_of_the_best_candidates) {
    auto d = samples::diagnosis(Verdict::no_gap);
    std::ranges::reverse(d.ranking);
    EXPECT_THAT(line(d, "Limits"),
                HasSubstr("would show shifted force threshold from 1 mN, bias of contact forces"));
}

TEST(DiagnosisText, an_effect_is_named_with_its_amplitude) {
    const auto d = samples::diagnosis(Verdict::effect);
    EXPECT_THAT(line(d, "Gap"), AllOf(StartsWith("yes"), HasSubstr("p = 0.004")));
    EXPECT_THAT(line(d, "Where"),
                AllOf(StartsWith("grain scatter while unloading"), HasSubstr("-7.8 sigma")));
    EXPECT_THAT(
        line(d, "Which"),
        HasSubstr("adhesion (0.264 ± 0.024 mJ/m²), with a probability of 87 % (18 effects were tested)"));
    EXPECT_THAT(line(d, "How far"),
                AllOf(StartsWith("adding adhesion takes away 79 % of the gap in held-out data (unloading"),
                      HasSubstr("from full simulations"),
                      HasSubstr("random effects (placebo) take away at most 12 %"),
                      HasSubstr("21 % of the gap remains unexplained (p < 0.0001)"),
                      HasSubstr("the signatures had predicted 81 % (90 % interval: 66 to 93 %)")));
    EXPECT_EQ(verdict_headline(d), "A gap; one effect takes away 79 % of the gap");
    EXPECT_THAT(verdict_sentence(d), HasSubstr("; adding it takes away 79 % of the gap."));
    EXPECT_THAT(line(d, "Limits"), HasSubstr("not measured: forces on the side walls"));
}

TEST(DiagnosisText, two_effects_are_named_together) {
    auto d = samples::diagnosis(Verdict::effect);
    d.causes.push_back(d.ranking[2]);
    EXPECT_THAT(line(d, "Which"),
                HasSubstr("mJ/m²) together with friction between grains (0.0182 ± 0.0048 higher than in the "
                          "scene)"));
    EXPECT_THAT(line(d, "How far"),
                StartsWith("adding adhesion and friction between grains takes away 79 %"));
    EXPECT_THAT(verdict_sentence(d), AllOf(HasSubstr("together with friction between grains"),
                                           HasSubstr("; adding both takes away 79 % of the gap.")));
}

TEST(DiagnosisText, several_packings_agree_or_the_differing_one_is_named) {
    auto d = samples::diagnosis(Verdict::group);
    EXPECT_THAT(line(d, "Gap"), Not(HasSubstr("packings")));
    d.packings = {{"out/A", 0.001, 2e-4, 1e-5, 0.3, false}, {"out/B", 0.2, 1e-4, 1e-5, 0.3, false}};
    EXPECT_THAT(line(d, "Gap"), HasSubstr("; 2 packings together, which agree."));
    EXPECT_THAT(line(d, "Limits"), Not(HasSubstr("difference between packings")));
    d.packings[1].differs = true;
    EXPECT_THAT(line(d, "Gap"), HasSubstr("of which out/B differs from the others by more than noise"));
    EXPECT_THAT(line(d, "Limits"), HasSubstr("a difference between packings is not an effect"));
    d.packings[0].differs = true;
    EXPECT_THAT(line(d, "Gap"), HasSubstr("which differ from one another by more than noise"));
}

TEST(DiagnosisText, a_group_lists_all_members_with_their_amplitudes) {
    const auto d = samples::diagnosis(Verdict::group);
    EXPECT_THAT(line(d, "Which"),
                AllOf(HasSubstr("adhesion (0.264"), HasSubstr("contacts made by surface displacement (0.332"),
                      HasSubstr("and friction between grains (0.0182"), HasSubstr("cannot tell them apart"),
                      Not(HasSubstr("together with"))));
    EXPECT_THAT(
        verdict_sentence(d),
        HasSubstr("any of adhesion, contacts made by surface displacement and friction between grains, which "
                  "these data cannot tell apart; adding the first of them takes away 64 %"));
}

TEST(DiagnosisText, data_that_are_too_few_to_name_an_effect_are_said_to_be) {
    auto d = samples::diagnosis(Verdict::unknown_effect);
    d.explanation = Explanation{.reduction = 0.92, .simulated = true, .placebo = 0.93, .needed = 1.03};
    EXPECT_THAT(line(d, "Which"),
                AllOf(StartsWith("these data cannot tell an effect from chance (18 effects were tested)"),
                      HasSubstr("takes away 92 % of the gap"),
                      HasSubstr("random effects (placebo) take away up to 93 %")));
    EXPECT_THAT(verdict_sentence(d), StartsWith("There is a gap whose cause these data cannot tell"));
    d.explanation->needed = 0.97;
    EXPECT_THAT(verdict_sentence(d), StartsWith("There is a gap that no tested effect explains"));
}

TEST(DiagnosisText, unknown_effect_states_how_little_the_best_explains) {
    const auto d = samples::diagnosis(Verdict::unknown_effect);
    EXPECT_THAT(line(d, "Which"), AllOf(StartsWith("no tested effect explains it (18 effects were tested)"),
                                        HasSubstr("adhesion"),
                                        HasSubstr("takes away 7 % of the gap, and 60 % would be needed")));
    EXPECT_THAT(line(d, "How far"),
                AllOf(HasSubstr("takes away 7 % of the gap"), HasSubstr("(placebo) take away at most 12 %")));
    EXPECT_THAT(verdict_sentence(d), HasSubstr("the best one takes away 7 % of the gap"));
}

TEST(DiagnosisText, an_effect_that_is_no_better_than_the_placebo_says_so) {
    auto d = samples::diagnosis(Verdict::unknown_effect);
    d.explanation->reduction = 0.9;
    d.explanation->placebo = 0.94;
    d.explanation->needed = 1.04;
    EXPECT_THAT(line(d, "Which"),
                HasSubstr("takes away 90 % of the gap, but random effects (placebo) take away up to 94 %"));
    EXPECT_THAT(diagnosis_text(d), Not(HasSubstr("104 %")));
    d.explanation->reduction = -0.4;
    EXPECT_THAT(line(d, "Which"), EndsWith("makes the gap 40 % larger."));
    EXPECT_THAT(line(d, "How far"), HasSubstr("all of the gap remains unexplained"));
    EXPECT_THAT(verdict_sentence(d), EndsWith("the best one makes the gap 40 % larger."));
}

TEST(DiagnosisText, calibration_suspect_names_the_parameter) {
    auto d = samples::diagnosis(Verdict::calibration_suspect);
    EXPECT_THAT(line(d, "Which"),
                HasSubstr("modulus of the grains: 2.30 ± 0.20 kPa higher than stated (4.6 times"));
    EXPECT_THAT(line(d, "How far"), StartsWith("correcting the parameter"));
    d.causes.push_back(d.ranking[6]);
    d.causes[0].effect = "modulus";
    d.causes[0].group = {"modulus", "stiffening"};
    EXPECT_THAT(line(d, "Which"), HasSubstr("cannot tell from stiffening at large strain"));
}

TEST(DiagnosisText, not_converged_names_the_key_and_its_value) {
    const auto d = samples::diagnosis(Verdict::not_converged);
    EXPECT_EQ(verdict_headline(d), "The simulation is not converged");
    EXPECT_THAT(verdict_sentence(d), HasSubstr("; set plate.speed = 0.0125 m/s instead of 0.025."));
    EXPECT_THAT(line(d, "Gap"), HasSubstr(", with plate.speed = 0.025 m/s instead of 0.1 (p"));
    EXPECT_THAT(line(d, "Which"),
                AllOf(HasSubstr("numerical error of the simulation"), HasSubstr("speed of the plate")));
    auto none = samples::diagnosis(Verdict::no_gap);
    none.refinements = {d.refinements[0]};
    EXPECT_EQ(verdict_sentence(none),
              "No gap is detectable, with plate.speed = 0.025 m/s instead of 0.1 (p = 0.44).");
}

TEST(DiagnosisText, ends_with_the_next_steps) {
    auto d = samples::diagnosis(Verdict::group);
    EXPECT_EQ(line(d, "Next"),
              "measure 3 more packings and diagnose each, to distinguish adhesion from friction (probability "
              "of success: 83 %); press a second cycle.");
    d.next.clear();
    EXPECT_THAT(line(d, "Next"), StartsWith("no measurement"));
}

TEST(DiagnosisText, a_gap_that_held_out_data_do_not_show_is_stated) {
    auto d = samples::diagnosis(Verdict::effect);
    d.gap_reduction->before = -0.3;
    d.explanation->held_out = false;
    EXPECT_THAT(line(d, "How far"), AllOf(HasSubstr("of the whole gap: the held-out data alone show none"),
                                          Not(HasSubstr("had predicted"))));
    d.explanation.reset();
    EXPECT_THAT(line(d, "How far"), HasSubstr("nothing was tried"));
}

TEST(DiagnosisText, a_remainder_within_noise_is_stated) {
    auto d = samples::diagnosis(Verdict::effect);
    d.explanation->leaves_more_than_noise = false;
    EXPECT_THAT(line(d, "How far"),
                AllOf(HasSubstr("the remainder cannot be distinguished from noise"),
                      Not(HasSubstr("remains unexplained")), Not(HasSubstr("rearranged"))));
    d.explanation->without = "13.6 mm of loading";
    EXPECT_THAT(line(d, "How far"),
                HasSubstr(", except at 13.6 mm of loading, where grains may have rearranged"));
}

// Cells that are framed in the figure are in the text, even without an entry.
TEST(DiagnosisText, framed_cells_are_in_the_text) {
    auto d = samples::diagnosis(Verdict::unknown_effect);
    d.where.clear();
    d.cells = {{"top_force", "load", 0.01, 15.2, 1}, {"mean_force", "load", 0.01, 4, -2}};
    EXPECT_EQ(line(d, "Where"),
              "2 of 2 values are beyond 3.9 sigma with the parameters as stated (largest: top force, 15.2 "
              "sigma), and none after recalibration.");
    d.cells[1].z_score_refitted = -5;
    EXPECT_THAT(
        line(d, "Where"),
        StartsWith(
            "1 of 2 values is beyond 3.9 sigma after recalibration (largest: mean force, -5.0 sigma)"));
    d.cells.resize(1);
    d.cells[0].z_score = 1;
    EXPECT_EQ(line(d, "Where"), "no single value stands out from the noise.");
}

}  // namespace
}  // namespace mcdem
