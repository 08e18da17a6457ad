#include "report/diagnosis_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "report/diagnosis_text.h"
#include "report/diagnosis_words.h"

namespace mcdem {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json number(const std::optional<double>& value) { return value ? number(*value) : Json(); }

Json text(const std::optional<std::string>& value) { return value ? Json(*value) : Json(); }

Json pair(const std::array<double, 2>& values) { return Json::array({number(values[0]), number(values[1])}); }

/// Without the last digits' noise: a nanometre is the smallest step.
Json millimetres(double metres) { return number(std::round(metres * 1e9) / 1e6); }

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
            {"region", text(entry.region)},
            {"z_score", number(entry.z_score)},
            {"z_score_refitted", number(entry.z_score_refitted)},
            {"force_class", text(entry.force_class)}};
}

Json cell_json(const WhereCell& cell) {
    return {{"observable", cell.observable},
            {"phase", phase(cell.phase)},
            {"displacement_mm", millimetres(cell.displacement)},
            {"z_score", number(cell.z_score)},
            {"z_score_refitted", number(cell.z_score_refitted)}};
}

Json cause_json(const Cause& cause) {
    return {{"effect", cause.effect},
            {"amplitude", number(cause.amplitude)},
            {"unit", cause.unit},
            {"confidence", number(cause.confidence)},
            {"group", cause.group},
            {"amplitude_error", number(cause.amplitude_error)},
            {"explained", number(cause.explained)},
            {"score", number(cause.score)},
            {"confirmed_score", number(cause.confirmed_score)}};
}

Json top_force_json(const std::array<double, 4>& row) {
    return {{"displacement_mm", millimetres(row[0])},
            {"experiment_N", number(row[1])},
            {"before_N", number(row[2])},
            {"after_N", number(row[3])}};
}

Json shrink_json(const std::optional<Shrink>& shrink) {
    if (!shrink) return {};
    Json metrics = Json::object();
    for (const auto& [name, values] : metrics_in_order(*shrink)) metrics[name] = pair(values);
    return {{"held_out", shrink->held_out},
            {"before", number(shrink->before)},
            {"after", number(shrink->after)},
            {"fraction", number(shrink->fraction)},
            {"interval", pair(shrink->interval)},
            {"placebo", number(shrink->placebo)},
            {"metrics", metrics},
            {"confirmed", number(shrink->confirmed)},
            {"fitted_displacement_mm", millimetres(shrink->fitted_displacement)},
            {"top_force", list(shrink->top_force, top_force_json)}};
}

Json limit_json(const DetectionLimit& limit) {
    return {{"effect", limit.effect},
            {"minimum_amplitude", number(limit.minimum_amplitude)},
            {"absorbed_by_calibration", number(limit.absorbed_by_calibration)},
            {"unit", limit.unit},
            {"group", limit.group}};
}

Json nuisance_json(const NuisanceFit& fit) {
    return {{"name", fit.name},           {"shift", number(fit.value)}, {"error", number(fit.error)},
            {"prior", number(fit.prior)}, {"unit", fit.unit},           {"at_bound", fit.at_bound}};
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
        case Verdict::calibration_suspect:
            break;
    }
    return "calibration_suspect";
}

std::string diagnosis_json(const Diagnosis& diagnosis) {
    const Json json{{"verdict", verdict_name(diagnosis.verdict)},
                    {"gap",
                     {{"detected", diagnosis.detected},
                      {"p_value", number(diagnosis.p_value)},
                      {"p_omnibus", number(diagnosis.p_omnibus)},
                      {"p_directed", number(diagnosis.p_directed)}}},
                    {"where", list(diagnosis.where, where_json)},
                    {"causes", list(diagnosis.causes, cause_json)},
                    {"shrink", shrink_json(diagnosis.shrink)},
                    {"detection_limits", list(diagnosis.detection_limits, limit_json)},
                    {"not_measured", diagnosis.not_measured},
                    {"seconds", number(diagnosis.seconds)},
                    {"sentence", verdict_sentence(diagnosis)},
                    {"where_threshold", number(diagnosis.where_threshold)},
                    {"cells", list(diagnosis.cells, cell_json)},
                    {"ranking", list(diagnosis.ranking, cause_json)},
                    {"nuisances", list(diagnosis.nuisances, nuisance_json)},
                    {"not_testable", diagnosis.not_testable},
                    {"provenance", diagnosis.provenance}};
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace mcdem
