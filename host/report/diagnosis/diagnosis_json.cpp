#include "report/diagnosis/diagnosis_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "report/diagnosis/diagnosis_text.h"
#include "report/diagnosis/diagnosis_words.h"

namespace mcdem::inline report {
namespace {

using Json = nlohmann::ordered_json;

// The library writes null for numbers that are not finite.

template <class Value>
Json or_null(const std::optional<Value>& value) {
    return value ? Json(*value) : Json();
}

/// Rounded to a nanometre, to remove noise in the last digits.
Json millimetres(double metres) { return std::round(metres * 1e9) / 1e6; }

Json millimetres(const std::array<double, 2>& metres) {
    return Json::array({millimetres(metres[0]), millimetres(metres[1])});
}

Json phase(const std::string& name) { return name.empty() ? Json() : Json(name); }

template <class Value, class Write>
Json list(const std::vector<Value>& values, Write write) {
    Json array = Json::array();
    for (const auto& value : values) array.push_back(write(value));
    return array;
}

Json where_json(const WhereEntry& entry) {
    return {{"observable", entry.observable},
            {"phase", phase(entry.phase)},
            {"displacement_mm", millimetres(entry.displacement)},
            {"region", or_null(entry.region)},
            {"z_score", entry.z_score},
            {"z_score_refitted", entry.z_score_refitted},
            {"force_class", or_null(entry.force_class)},
            {"difference", entry.difference}};
}

Json cell_json(const WhereCell& cell) {
    return {{"observable", cell.observable},
            {"phase", phase(cell.phase)},
            {"displacement_mm", millimetres(cell.displacement)},
            {"z_score", cell.z_score},
            {"z_score_refitted", cell.z_score_refitted},
            {"difference", cell.difference}};
}

Json cause_json(const Cause& cause) {
    return {{"effect", cause.effect},
            {"amplitude", cause.amplitude},
            {"unit", cause.unit},
            {"confidence", cause.confidence},
            {"group", cause.group},
            {"amplitude_error", cause.amplitude_error},
            {"explained", cause.explained},
            {"score", cause.score},
            {"confirmed_score", or_null(cause.confirmed_score)}};
}

Json top_force_json(const std::array<double, 4>& row) {
    return {{"displacement_mm", millimetres(row[0])},
            {"experiment_N", row[1]},
            {"before_N", row[2]},
            {"after_N", row[3]}};
}

Json gap_reduction_json(const std::optional<GapReduction>& gap_reduction) {
    if (!gap_reduction) return {};
    Json metrics = Json::object();
    for (const auto& [name, values] : metrics_in_order(*gap_reduction)) metrics[name] = values;
    return {{"held_out", gap_reduction->held_out},
            {"before", gap_reduction->before},
            {"after", gap_reduction->after},
            {"fraction", gap_reduction->fraction},
            {"interval", gap_reduction->interval},
            {"placebo", gap_reduction->placebo},
            {"metrics", metrics},
            {"confirmed", or_null(gap_reduction->confirmed)},
            {"fitted_displacement_mm", millimetres(gap_reduction->fitted_displacement)},
            {"top_force", list(gap_reduction->top_force, top_force_json)}};
}

Json explanation_json(const std::optional<Explanation>& explanation) {
    if (!explanation) return {};
    return {{"reduction", explanation->reduction},
            {"simulated", explanation->simulated},
            {"held_out", explanation->held_out},
            {"placebo", explanation->placebo},
            {"needed", explanation->needed},
            {"remainder", explanation->remainder()},
            {"remainder_p", explanation->remainder_p},
            {"leaves_more_than_noise", explanation->leaves_more_than_noise}};
}

Json packing_json(const PackingAgreement& packing) {
    return {{"experiment", packing.experiment},   {"gap_p", packing.gap_p},
            {"amplitude", packing.amplitude},     {"amplitude_error", packing.amplitude_error},
            {"agreement_p", packing.agreement_p}, {"differs", packing.differs}};
}

Json refinement_json(const Refinement& refinement) {
    return {{"effect", refinement.effect}, {"key", refinement.key},   {"was", refinement.from},
            {"to", refinement.to},         {"unit", refinement.unit}, {"done", refinement.done}};
}

Json step_json(const NextStep& step) { return {{"what", step.what}, {"power", or_null(step.power)}}; }

Json limit_json(const DetectionLimit& limit) {
    return {{"effect", limit.effect},
            {"minimum_amplitude", limit.minimum_amplitude},
            {"absorbed_by_calibration", limit.absorbed_by_calibration},
            {"unit", limit.unit},
            {"group", limit.group}};
}

Json nuisance_json(const NuisanceFit& fit) {
    return {{"name", fit.name},   {"shift", fit.value}, {"error", fit.error},
            {"prior", fit.prior}, {"unit", fit.unit},   {"at_bound", fit.at_bound}};
}

}  // namespace

std::string verdict_name(Verdict verdict) {
    switch (verdict) {
        case Verdict::no_gap:
            return "no_gap";
        case Verdict::effect:
            return "effect";
        case Verdict::group:
            return "group";
        case Verdict::unknown_effect:
            return "unknown_effect";
        case Verdict::not_converged:
            return "not_converged";
        case Verdict::calibration_suspect:
            break;
    }
    return "calibration_suspect";
}

std::string diagnosis_json(const Diagnosis& diagnosis) {
    const Json json{{"verdict", verdict_name(diagnosis.verdict)},
                    {"gap",
                     {{"detected", diagnosis.detected},
                      {"p_value", diagnosis.p_value},
                      {"p_omnibus", diagnosis.p_omnibus},
                      {"p_directed", diagnosis.p_directed}}},
                    {"where", list(diagnosis.where, where_json)},
                    {"causes", list(diagnosis.causes, cause_json)},
                    {"explanation", explanation_json(diagnosis.explanation)},
                    {"shrink", gap_reduction_json(diagnosis.gap_reduction)},
                    {"detection_limits", list(diagnosis.detection_limits, limit_json)},
                    {"not_measured", diagnosis.not_measured},
                    {"seconds", diagnosis.seconds},
                    {"sentence", verdict_sentence(diagnosis)},
                    {"where_threshold", diagnosis.where_threshold},
                    {"cells", list(diagnosis.cells, cell_json)},
                    {"ranking", list(diagnosis.ranking, cause_json)},
                    {"nuisances", list(diagnosis.nuisances, nuisance_json)},
                    {"not_testable", diagnosis.not_testable},
                    {"refinements", list(diagnosis.refinements, refinement_json)},
                    {"next", list(diagnosis.next, step_json)},
                    {"packings", list(diagnosis.packings, packing_json)},
                    {"provenance", diagnosis.provenance}};
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace mcdem::report
