#include <nlohmann/json.hpp>

#include "challenge/figure_values.h"
#include "cli/challenge/challenge_tables.h"

namespace mcdem::inline cli {
namespace {

using Json = nlohmann::ordered_json;

Json share_json(const Share& share) {
    const auto [low, high] = wilson_interval(share.hits, share.of);
    return {{"hits", share.hits},
            {"of", share.of},
            {"share", share.of > 0 ? Json(share.value()) : Json()},
            {"interval", {low, high}}};
}

Json shares_json(const std::map<std::string, Share>& shares) {
    Json json = Json::object();
    for (const auto& [name, share] : shares) json[name] = share_json(share);
    return json;
}

Json merits_json(const Merits& m) {
    return {{"false_alarms", share_json(m.false_alarms)},
            {"detected", share_json(m.detected)},
            {"detected_clear", share_json(m.detected_clear)},
            {"led_by_truth", share_json(m.led_by_truth)},
            {"truth_in_group", share_json(m.truth_in_group)},
            {"named", share_json(m.named)},
            {"group_size", m.group_size},
            {"sharpness", m.sharpness},
            {"named_unknown", share_json(m.named_unknown)},
            {"named_outside_prior", share_json(m.named_outside_prior)},
            {"suspected", share_json(m.suspected)},
            {"pair_led", share_json(m.pair_led)},
            {"pair_found", share_json(m.pair_found)},
            {"brier", m.brier},
            {"right_where_named", share_json(m.right_where_named)},
            {"detected_by_effect", shares_json(m.detected_by_effect)},
            {"named_by_effect", shares_json(m.named_by_effect)},
            {"named_by_unknown", shares_json(m.named_by_unknown)}};
}

Json arm_json(const ArmScore& arm) {
    Json limits;
    if (arm.has_limits)
        for (const auto& [name, value] : named_limits(arm.limits)) limits[std::string(name)] = value;
    return {{"name", arm.name},
            {"meaning", arm.meaning},
            {"limits", limits},
            {"first_half", merits_json(arm.first)},
            {"scored_half", merits_json(arm.second)}};
}

}  // namespace

std::string score_json(const ChallengeScore& score) {
    Json arms = Json::array();
    for (const ArmScore& arm : score.arms) arms.push_back(arm_json(arm));
    return Json{{"cases", score.cases},
                {"not_diagnosed", score.not_diagnosed},
                {"shrink",
                 {{"cases", score.gap_reduction.cases},
                  {"median_error", score.gap_reduction.median_error},
                  {"covered", share_json(score.gap_reduction.covered)}}},
                {"methods", arms}}
               .dump(1) +
           "\n";
}

}  // namespace mcdem::cli
