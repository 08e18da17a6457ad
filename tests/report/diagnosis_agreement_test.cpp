// Title, text, figure and JSON file of a diagnosis agree for all results.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <set>

#include "diagnose/decide/decision.h"
#include "report/diagnosis/diagnosis_json.h"
#include "report/diagnosis/diagnosis_text.h"
#include "report/diagnosis/diagnosis_values.h"
#include "report/diagnosis/diagnosis_words.h"
#include "report/verdict_line.h"

namespace mcdem {
namespace {

constexpr int findings_tried = 3000;
const std::vector<std::string> names{"adhesion", "friction", "plate_speed", "plate_tilt", "modulus"};
constexpr int effects = 4;
constexpr std::size_t numerics = 2;

class RandomDiagnosis {
public:
    explicit RandomDiagnosis(unsigned seed) : random_(seed) {
        findings_.p_value = coin() ? uniform(0, 0.02) : 1e-8;
        findings_.names = names;
        findings_.effects = effects;
        findings_.numerics = {numerics};
        for (std::size_t c = 0; c < names.size(); ++c) findings_.gain.push_back(uniform(-1, 60));
        findings_.placebo = uniform(0, 0.8);
        findings_.held_out = coin();
        findings_.held_out_noise = findings_.held_out ? uniform(0, 0.5) : 0;
        for (std::size_t c = 0; c < names.size(); ++c)
            if (coin()) add_proposal({c});
        if (coin()) add_proposal({0, 1 + index(effects - 1)});
    }

    Diagnosis diagnosis() {
        const Decision decision = decide(findings_, {});
        Diagnosis d;
        d.verdict = decision.verdict;
        d.detected = d.verdict != Verdict::no_gap;
        d.p_value = findings_.p_value;
        d.explanation = explanation_of(findings_, decision, {});
        for (const std::size_t c : d.detected ? decision.group : std::vector<std::size_t>{}) {
            d.causes.emplace_back();
            d.causes.back().effect = names[c];
            d.causes.back().amplitude = uniform(-1, 1);
            d.causes.back().amplitude_error = 0.1;
            d.causes.back().confidence = decision.confidence[c];
            d.causes.back().group = {names[c]};
        }
        d.ranking = d.causes;
        if (coin())
            for (const char* name : {"out/A", "out/B", "out/C"})
                d.packings.push_back(
                    {name, uniform(0, 1), uniform(-1, 1), 0.1, uniform(0, 1), coin() && coin()});
        add_cells(d);
        if (d.explanation) {
            d.gap_reduction = GapReduction{};
            d.gap_reduction->before = uniform(-10, 100);
            d.gap_reduction->fraction = uniform(-1, 1);
            d.gap_reduction->placebo = d.explanation->placebo;
        }
        return d;
    }

private:
    double uniform(double low, double high) { return std::uniform_real_distribution<>(low, high)(random_); }
    bool coin() { return uniform(0, 1) < 0.5; }
    std::size_t index(std::size_t count) { return random_() % count; }

    void add_proposal(std::vector<std::size_t> candidates) {
        Proposal p;
        p.amplitudes.assign(candidates.size(), 1);
        p.errors.assign(candidates.size(), 0.1);
        p.candidates = std::move(candidates);
        p.gain = uniform(0, 60);
        p.misfit_p = coin() ? 1e-9 : uniform(0, 1);
        p.reduction = uniform(-1, 1);
        if (coin()) p.confirmed_gain = uniform(-5, 60);
        if (coin()) p.confirmed_reduction = coin() ? uniform(0.59, 0.61) : uniform(-1, 1);
        findings_.proposals.push_back(p);
    }

    /// As locate() does: with a gap, one entry for every significant cell after recalibration.
    void add_cells(Diagnosis& d) {
        d.where_threshold = 4;
        const double raw = uniform(0, 6), refitted = coin() ? 0.5 : uniform(0, 6);
        for (const char* phase : {"load", "unload"})
            for (const double displacement : {0.01, 0.02}) {
                d.cells.push_back(
                    {"top_force", phase, displacement, uniform(-raw, raw), uniform(-refitted, refitted)});
                const WhereCell& cell = d.cells.back();
                if (d.detected && std::abs(cell.z_score_refitted) >= d.where_threshold)
                    d.where.push_back({.observable = cell.observable,
                                       .phase = phase,
                                       .displacement = {displacement, displacement},
                                       .region = {},
                                       .force_class = {},
                                       .z_score = cell.z_score,
                                       .z_score_refitted = cell.z_score_refitted});
            }
    }

    std::mt19937 random_;
    Findings findings_;
};

bool names_a_cause(Verdict verdict) {
    return verdict != Verdict::no_gap && verdict != Verdict::unknown_effect;
}

/// All phrases like "81 % of the gap" and "makes the gap 20 % larger" in a text, the latter with a minus; not
/// what remains of it.
std::set<std::string> parts_of_the_gap(const std::string& text) {
    static const std::regex part("((< )?-?[0-9]+ %) of the gap(?! remains)"),
        more("gap ((< )?[0-9]+ %) larger");
    const std::sregex_iterator end;
    std::set<std::string> found;
    for (std::sregex_iterator m(text.begin(), text.end(), part); m != end; ++m) found.insert((*m)[1]);
    for (std::sregex_iterator m(text.begin(), text.end(), more); m != end; ++m)
        found.insert("-" + (*m)[1].str());
    return found;
}

std::string part_words(double reduction) {
    return reduction < 0 ? "-" + percent(-reduction) : percent(reduction);
}

bool says(const std::string& text, const char* words) { return text.find(words) != std::string::npos; }

TEST(DiagnosisAgreement, TitleFiguresTextAndFileAgree) {
    std::set<Verdict> seen;
    for (unsigned seed = 0; seed < findings_tried; ++seed) {
        const Diagnosis d = RandomDiagnosis(seed).diagnosis();
        seen.insert(d.verdict);
        const std::string title = verdict_headline(d), sentence = verdict_sentence(d),
                          how_far = line(d, "How far");
        const std::string all = title + "; " + sentence + "; " + diagnosis_text(d);
        SCOPED_TRACE(std::to_string(seed) + ": " + all);
        ASSERT_EQ(d.explanation.has_value(), d.detected && !d.causes.empty());
        EXPECT_EQ(says(title, "No detectable"), d.verdict == Verdict::no_gap);
        EXPECT_EQ(says(title, "no tested effect"), d.verdict == Verdict::unknown_effect);
        if (d.explanation) {
            const Explanation& e = *d.explanation;
            EXPECT_EQ(names_a_cause(d.verdict), e.reduction >= e.needed);
            EXPECT_EQ(says(title, "not converged"), d.verdict == Verdict::not_converged);
            const auto is_numerical = [](const Cause& cause) { return cause.effect == names[numerics]; };
            EXPECT_EQ(d.verdict == Verdict::not_converged,
                      names_a_cause(d.verdict) && std::ranges::any_of(d.causes, is_numerical));
            if (names_a_cause(d.verdict)) {
                EXPECT_GT(e.reduction, e.placebo);
                EXPECT_GT(d.causes.front().confidence, 0);
            }
            EXPECT_EQ(parts_of_the_gap(all), std::set{part_words(e.reduction)})
                << "one number, wherever it is told";
            EXPECT_TRUE(says(how_far, ("(placebo) take away at most " + percent(e.placebo)).c_str()));
            EXPECT_EQ(says(how_far, "of the gap remains unexplained"), e.leaves_more_than_noise);
            EXPECT_EQ(says(how_far, "from full simulations"), e.simulated);
        } else {
            EXPECT_TRUE(parts_of_the_gap(all).empty());
        }
        const auto differs = [](const PackingAgreement& packing) { return packing.differs; };
        const bool some_differ = std::ranges::any_of(d.packings, differs);
        EXPECT_EQ(says(line(d, "Gap"), "which agree"), !d.packings.empty() && !some_differ);
        EXPECT_EQ(says(line(d, "Gap"), "by more than noise;") || says(line(d, "Gap"), "by more than noise."),
                  some_differ);
        EXPECT_EQ(says(line(d, "Limits"), "a difference between packings"), some_differ);
        bool framed = false;
        const auto values = diagnosis_figure_values(d);
        for (const auto& panel : values["where"]["panels"])
            for (const auto& cell : panel["cells"]) framed = framed || cell["stands_out"];
        EXPECT_NE(says(line(d, "Where"), "no single value"), framed);
        const auto json = nlohmann::json::parse(diagnosis_json(d));
        EXPECT_EQ(json["sentence"], sentence);
        EXPECT_EQ(json["explanation"].is_null(), !d.explanation);
        if (d.explanation) {
            EXPECT_EQ(json["explanation"]["reduction"], d.explanation->reduction);
        }
    }
    EXPECT_EQ(seen.size(), 6u) << "every verdict came about";
}

}  // namespace
}  // namespace mcdem
