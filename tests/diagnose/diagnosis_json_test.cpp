#include "diagnose/decide/diagnosis_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/errors.h"
#include "diagnose/diagnosis_samples.h"

namespace mcdem {
namespace {

using testing::ElementsAre;
using Json = nlohmann::ordered_json;

std::vector<std::string> keys_of(const Json& object) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : object.items()) keys.push_back(key);
    return keys;
}

Json parsed(const Diagnosis& diagnosis) { return Json::parse(diagnosis_json(diagnosis)); }

/// Calls `check` on every value of a document.
void each(const Json& json, const std::function<void(const Json&)>& check) {
    check(json);
    if (json.is_structured())
        for (const auto& part : json) each(part, check);
}

TEST(DiagnosisJson, has_the_documented_keys_in_their_order) {
    const auto json = parsed(samples::diagnosis(Verdict::effect));
    EXPECT_THAT(keys_of(json), ElementsAre("verdict", "gap", "where", "causes", "explanation", "shrink",
                                           "detection_limits", "not_measured", "seconds", "where_threshold",
                                           "cells", "ranking", "nuisances", "check_first", "missing_bins",
                                           "not_testable", "refinements", "next", "packings", "provenance"));
    EXPECT_THAT(keys_of(json["gap"]), ElementsAre("detected", "p_value", "p_omnibus", "p_directed"));
    EXPECT_THAT(keys_of(json["where"][0]),
                ElementsAre("observable", "phase", "displacement_mm", "region", "z_score", "z_score_refitted",
                            "force_class", "difference"));
    const auto cause = ElementsAre("effect", "amplitude", "unit", "confidence", "group", "amplitude_error",
                                   "at_limit", "explained", "score", "confirmed_score");
    EXPECT_THAT(keys_of(json["causes"][0]), cause);
    EXPECT_THAT(keys_of(json["ranking"][17]), cause);
    EXPECT_THAT(keys_of(json["next"][0]), ElementsAre("what", "power"));
    EXPECT_THAT(keys_of(json["packings"][0]),
                ElementsAre("experiment", "gap_p", "amplitude", "amplitude_error", "agreement_p", "differs"));
    EXPECT_THAT(keys_of(parsed(samples::diagnosis(Verdict::not_converged))["refinements"][0]),
                ElementsAre("effect", "key", "was", "to", "unit", "done"));
    EXPECT_THAT(keys_of(json["explanation"]),
                ElementsAre("reduction", "simulated", "held_out", "placebo", "needed", "remainder",
                            "remainder_p", "leaves_more_than_noise", "without"));
    EXPECT_THAT(keys_of(json["shrink"]),
                ElementsAre("held_out", "before", "after", "fraction", "interval", "placebo", "metrics",
                            "confirmed", "fitted_displacement_mm", "top_force"));
    EXPECT_THAT(keys_of(json["shrink"]["metrics"]), ElementsAre("Rtop", "errf", "errZ", "bhat"));
    EXPECT_THAT(keys_of(json["detection_limits"][0]),
                ElementsAre("effect", "minimum_amplitude", "absorbed_by_calibration", "unit", "group"));
    EXPECT_THAT(keys_of(json["nuisances"][0]),
                ElementsAre("name", "shift", "error", "prior", "unit", "at_bound"));
    EXPECT_THAT(keys_of(json["cells"][0]), ElementsAre("observable", "phase", "displacement_mm", "z_score",
                                                       "z_score_refitted", "difference"));
}

TEST(DiagnosisJson, has_the_documented_types) {
    const auto json = parsed(samples::diagnosis(Verdict::effect));
    for (const char* list : {"where", "causes", "detection_limits", "not_measured", "cells", "ranking",
                             "nuisances", "not_testable"})
        EXPECT_TRUE(json[list].is_array()) << list;
    EXPECT_TRUE(json["verdict"].is_string());
    EXPECT_TRUE(json["gap"]["detected"].is_boolean());
    EXPECT_TRUE(json["gap"]["p_value"].is_number());
    EXPECT_TRUE(json["provenance"].is_object());
    EXPECT_TRUE(json["causes"][0]["group"].is_array());
    EXPECT_TRUE(json["nuisances"][0]["at_bound"].is_boolean());
    EXPECT_EQ(json["shrink"]["interval"].size(), 2u);
}

TEST(DiagnosisJson, contains_the_values) {
    const auto d = samples::diagnosis(Verdict::effect);
    const auto json = parsed(d);
    EXPECT_EQ(json["verdict"], "effect");
    EXPECT_EQ(json["cells"].size(), d.cells.size());
    EXPECT_EQ(json["where"][0]["displacement_mm"], Json::parse("[21.0, 27.0]"));
    EXPECT_EQ(json["where"][1]["displacement_mm"], Json::parse("[15.0, 21.0]"));  // not 20.999999999999996
    EXPECT_EQ(json["where"][0]["z_score"], d.where[0].z_score);
    EXPECT_EQ(json["causes"][0]["amplitude"], d.causes[0].amplitude);
    EXPECT_EQ(json["causes"][0]["confirmed_score"], *d.causes[0].confirmed_score);
    for (const auto& [key, value] :
         std::map<std::string, double>{{"before", d.gap_reduction->before},
                                       {"after", d.gap_reduction->after},
                                       {"fraction", 0.81},
                                       {"placebo", 0.12},
                                       {"confirmed", d.gap_reduction->confirmed.value()}})
        EXPECT_EQ(json["shrink"][key], value) << key;
    EXPECT_EQ(json["shrink"]["interval"], Json(d.gap_reduction->interval));
    EXPECT_EQ(json["shrink"]["fitted_displacement_mm"], Json::parse("[0.0, 18.0]"));
    EXPECT_EQ(json["shrink"]["metrics"]["Rtop"], Json::parse("[0.874, 0.991]"));
    EXPECT_EQ(json["shrink"]["top_force"][20]["displacement_mm"], 30.0);
    EXPECT_EQ(json["nuisances"][0]["shift"], 180.0);
    EXPECT_EQ(json["provenance"]["seed"], "17");
}

TEST(DiagnosisJson, missing_values_are_null_or_empty) {
    const auto json = parsed({});
    EXPECT_EQ(json["verdict"], "no_gap");
    EXPECT_TRUE(json["shrink"].is_null());
    EXPECT_EQ(json["where"], Json::array());
    EXPECT_EQ(json["provenance"], Json::object());
    Diagnosis d;
    d.where.push_back({});
    const auto entry = parsed(d)["where"][0];
    EXPECT_TRUE(entry["phase"].is_null() && entry["region"].is_null() && entry["force_class"].is_null());
}

TEST(DiagnosisJson, numbers_that_are_not_finite_become_null) {
    auto d = samples::diagnosis(Verdict::effect);
    d.causes[0].amplitude = std::nan("");
    d.gap_reduction->metrics[0].second = {INFINITY, 1};
    const auto json = parsed(d);
    EXPECT_TRUE(json["detection_limits"][12]["minimum_amplitude"].is_null());  // infinite: cannot be detected
    EXPECT_TRUE(json["causes"][0]["amplitude"].is_null());
    EXPECT_TRUE(json["shrink"]["metrics"]["Rtop"][0].is_null());
    each(json, [](const Json& value) {
        if (value.is_number()) {
            EXPECT_TRUE(std::isfinite(value.get<double>()));
        }
    });
}

TEST(DiagnosisJson, any_text_is_kept_and_invalid_bytes_are_replaced) {
    const std::string hostile = "\"}]\n\\ <x> \x01";
    auto d = samples::with_texts(samples::diagnosis(Verdict::group), hostile);
    EXPECT_EQ(parsed(d)["causes"][0]["effect"], hostile);
    d = samples::with_texts(d, "caf\xe9");
    EXPECT_EQ(parsed(d)["causes"][0]["effect"], "caf\xEF\xBF\xBD");
}

TEST(DiagnosisJson, verdicts_have_unique_names) {
    std::set<std::string> names;
    for (const auto verdict : samples::all_verdicts) names.insert(verdict_name(verdict));
    EXPECT_EQ(names, (std::set<std::string>{"no_gap", "effect", "group", "unknown_effect", "not_converged",
                                            "calibration_suspect"}));
}

TEST(DiagnosisJson, is_read_back_as_written) {
    for (const auto verdict : samples::all_verdicts) {
        auto d = samples::diagnosis(verdict);
        d.cells.front().z_score = std::nan("");
        d.detection_limits.front().minimum_amplitude = std::numeric_limits<double>::infinity();
        const auto text = diagnosis_json(d);
        EXPECT_EQ(diagnosis_json(diagnosis_of_json(text, "here")), text);
    }
    const auto bare = diagnosis_json({});
    EXPECT_EQ(diagnosis_json(diagnosis_of_json(bare, "here")), bare);
}

TEST(DiagnosisJson, invalid_documents_are_refused_with_the_position) {
    auto json = parsed(samples::diagnosis(Verdict::effect));
    json.erase("ranking");
    auto wrong = parsed(samples::diagnosis(Verdict::effect));
    wrong["verdict"] = "perhaps";
    auto text_for_number = parsed(samples::diagnosis(Verdict::effect));
    text_for_number["cells"][3]["z_score"] = "six";
    for (const auto& [text, part] :
         std::vector<std::pair<std::string, std::string>>{{json.dump(), "ranking"},
                                                          {wrong.dump(), "perhaps"},
                                                          {text_for_number.dump(), "number"},
                                                          {"{\"verdict\":", "parse"},
                                                          {"[]", "type"},
                                                          {"", "parse"}}) {
        try {
            diagnosis_of_json(text, "out/diagnosis.json");
            FAIL() << text;
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), testing::StartsWith("out/diagnosis.json: must be a diagnosis.json"));
            EXPECT_THAT(error.what(), testing::HasSubstr(part));
        }
    }
}

}  // namespace
}  // namespace mcdem
