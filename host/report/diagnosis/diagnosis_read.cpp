#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/errors.h"
#include "report/diagnosis/diagnosis_json.h"
#include "report/page/labels.h"

namespace mcdem::inline report {
namespace {

using Json = nlohmann::ordered_json;

/// null means not finite or unknown.
double number(const Json& json, double otherwise = std::numeric_limits<double>::quiet_NaN()) {
    return json.is_null() ? otherwise : json.get<double>();
}

std::string text_or_empty(const Json& json) { return json.is_null() ? "" : json.get<std::string>(); }

template <class Value>
std::optional<Value> optional_of(const Json& json) {
    return json.is_null() ? std::nullopt : std::optional(json.get<Value>());
}

std::array<double, 2> pair_of(const Json& json, double unit = 1) {
    return {number(json.at(0)) * unit, number(json.at(1)) * unit};
}

template <class Read>
auto list_of(const Json& json, Read read) {
    std::vector<decltype(read(json))> list;
    for (const auto& item : json) list.push_back(read(item));
    return list;
}

/// Missing in files of earlier versions.
double difference_of(const Json& json) {
    return json.contains("difference") ? number(json["difference"]) : 0;
}

WhereEntry where_of(const Json& json) {
    return {.observable = json.at("observable"),
            .phase = text_or_empty(json.at("phase")),
            .displacement = pair_of(json.at("displacement_mm"), mm),
            .region = optional_of<std::string>(json.at("region")),
            .force_class = optional_of<std::string>(json.at("force_class")),
            .z_score = number(json.at("z_score")),
            .z_score_refitted = number(json.at("z_score_refitted")),
            .difference = difference_of(json)};
}

WhereCell cell_of(const Json& json) {
    return {json.at("observable"),
            text_or_empty(json.at("phase")),
            number(json.at("displacement_mm")) * mm,
            number(json.at("z_score")),
            number(json.at("z_score_refitted")),
            difference_of(json)};
}

Cause cause_of(const Json& json) {
    return {.effect = json.at("effect"),
            .amplitude = number(json.at("amplitude")),
            .amplitude_error = number(json.at("amplitude_error"), std::numeric_limits<double>::infinity()),
            .unit = json.at("unit"),
            .confidence = number(json.at("confidence")),
            .explained = number(json.at("explained")),
            .group = json.at("group"),
            .score = number(json.at("score")),
            .confirmed_score = optional_of<double>(json.at("confirmed_score"))};
}

NuisanceFit nuisance_of(const Json& json) {
    return {json.at("name"),          number(json.at("shift")), number(json.at("error")),
            number(json.at("prior")), json.at("unit"),          json.at("at_bound")};
}

DetectionLimit limit_of(const Json& json) {
    return {
        .effect = json.at("effect"),
        .unit = json.at("unit"),
        .minimum_amplitude = number(json.at("minimum_amplitude"), std::numeric_limits<double>::infinity()),
        .absorbed_by_calibration = number(json.at("absorbed_by_calibration")),
        .group = json.at("group")};
}

Explanation explanation_of(const Json& json) {
    return {.reduction = number(json.at("reduction")),
            .simulated = json.at("simulated"),
            .held_out = json.at("held_out"),
            .placebo = number(json.at("placebo")),
            .needed = number(json.at("needed")),
            .remainder_p = number(json.at("remainder_p")),
            .leaves_more_than_noise = json.at("leaves_more_than_noise")};
}

PackingAgreement packing_of(const Json& json) {
    return {json.at("experiment"),
            number(json.at("gap_p")),
            number(json.at("amplitude")),
            number(json.at("amplitude_error"), std::numeric_limits<double>::infinity()),
            number(json.at("agreement_p")),
            json.at("differs")};
}

Refinement refinement_of(const Json& json) {
    return {json.at("effect"),      json.at("key"),        json.at("unit"),
            number(json.at("was")), number(json.at("to")), json.at("done")};
}

NextStep step_of(const Json& json) { return {json.at("what"), optional_of<double>(json.at("power"))}; }

GapReduction gap_reduction_of(const Json& json) {
    GapReduction gap_reduction{.held_out = json.at("held_out"),
                               .before = number(json.at("before")),
                               .after = number(json.at("after")),
                               .fraction = number(json.at("fraction")),
                               .interval = pair_of(json.at("interval")),
                               .placebo = number(json.at("placebo")),
                               .confirmed = optional_of<double>(json.at("confirmed")),
                               .metrics = {},
                               .top_force = {},
                               .fitted_displacement = pair_of(json.at("fitted_displacement_mm"), mm)};
    for (const auto& [name, values] : json.at("metrics").items())
        gap_reduction.metrics[name] = pair_of(values);
    for (const auto& row : json.at("top_force"))
        gap_reduction.top_force.push_back({number(row.at("displacement_mm")) * mm,
                                           number(row.at("experiment_N")), number(row.at("before_N")),
                                           number(row.at("after_N"))});
    return gap_reduction;
}

Verdict verdict_of(const std::string& word) {
    for (const auto verdict : {Verdict::no_gap, Verdict::effect, Verdict::group, Verdict::unknown_effect,
                               Verdict::not_converged, Verdict::calibration_suspect})
        if (verdict_name(verdict) == word) return verdict;
    throw std::invalid_argument("unknown verdict: " + word);
}

Diagnosis read(const Json& json) {
    Diagnosis d;
    d.verdict = verdict_of(json.at("verdict"));
    const auto& gap = json.at("gap");
    d.detected = gap.at("detected");
    d.p_value = number(gap.at("p_value"));
    d.p_omnibus = number(gap.at("p_omnibus"));
    d.p_directed = number(gap.at("p_directed"));
    d.where = list_of(json.at("where"), where_of);
    d.cells = list_of(json.at("cells"), cell_of);
    d.causes = list_of(json.at("causes"), cause_of);
    d.ranking = list_of(json.at("ranking"), cause_of);
    d.nuisances = list_of(json.at("nuisances"), nuisance_of);
    if (const auto found = json.find("explanation"); found != json.end() && !found->is_null())
        d.explanation = explanation_of(*found);  // missing in files of earlier versions
    if (!json.at("shrink").is_null()) d.gap_reduction = gap_reduction_of(json.at("shrink"));
    d.detection_limits = list_of(json.at("detection_limits"), limit_of);
    d.not_measured = json.at("not_measured");
    d.not_testable = json.at("not_testable");
    if (json.contains("refinements")) d.refinements = list_of(json.at("refinements"), refinement_of);
    if (json.contains("next")) d.next = list_of(json.at("next"), step_of);
    if (json.contains("packings")) d.packings = list_of(json.at("packings"), packing_of);
    d.seconds = number(json.at("seconds"));
    d.provenance = json.at("provenance");
    d.where_threshold = number(json.at("where_threshold"), 0);
    return d;
}

}  // namespace

Diagnosis diagnosis_of_json(const std::string& text, const std::string& where) {
    try {
        return read(Json::parse(text));
    } catch (const std::exception& error) {
        throw InputError(where + ": must be a diagnosis.json that `mcdem diagnose` wrote; " + error.what());
    }
}

}  // namespace mcdem::report
