#include "challenge/limits.h"

#include <algorithm>

namespace mcdem::inline challenge {
namespace {

struct Choice {
    std::string_view name;
    double Limits::*limit;
    std::vector<double> values;
};

// clang-format off
const std::vector<Choice> choices{
    {"false_alarm",  &Limits::false_alarm,  {0.01}},  // a level of significance has a fixed meaning and is not tuned
    {"reduction",    &Limits::reduction,    {0.5, 0.6, 0.7, 0.8}},
    {"over_placebo", &Limits::over_placebo, {0.1, 0.2, 0.4}},
    {"misfit",       &Limits::misfit,       {1e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1}},
    {"remainder",    &Limits::remainder,    {0.1, 0.2, 0.3, 0.4}},
    {"form_remainder", &Limits::form_remainder, {0.05, 0.1, 0.15, 0.2}},
    {"pair_reduction", &Limits::pair_reduction, {0.6, 0.7, 0.8, 0.9}},
    {"pair_misfit",  &Limits::pair_misfit,  {0.01, 0.02, 0.05, 0.1, 0.2}},
    {"only_noise",   &Limits::only_noise,   {0.01, 0.05, 0.2, 2}},
    {"group",        &Limits::group,        {1, 2, 3, 5}},
    {"group_share",  &Limits::group_share,  {0.01, 0.02, 0.04, 0.06, 0.1}},
    {"second_gain",  &Limits::second_gain,  {4, 8, 12, 20}},
    {"second_share", &Limits::second_share, {0.02, 0.04, 0.08, 0.15, 0.3}},
    {"second_certain", &Limits::second_certain, {25, 50, 100, 1e9}},
    {"right_below",  &Limits::right_below,  {0.03, 0.1, 0.3}},
    {"right_above",  &Limits::right_above,  {0.9, 0.94, 0.96, 0.98}},
    {"right_form",   &Limits::right_form,   {0.2, 0.4, 0.6, 0.8}},
};
// clang-format on
constexpr int max_rounds = 5;

double above(double value, double bar) { return std::max(0.0, value - bar); }
double below(const Share& share, double bar) { return share.of > 0 ? std::max(0.0, bar - share.value()) : 0; }

}  // namespace

double objective(const Merits& m) {
    const Bars bars;
    const double missing = above(m.false_alarms.value(), bars.false_alarms) +
                           above(m.named_unknown.value(), bars.named_unknown) +
                           above(m.named_outside_prior.value(), bars.named_outside_prior) +
                           above(m.group_size, bars.group_size) + below(m.led_by_truth, bars.led_by_truth) +
                           below(m.truth_in_group, bars.truth_in_group);
    return m.sharpness + 0.5 * m.pair_found.value() - m.brier - 5 * missing;
}

Merits merits_with(std::span<const LimitCase> cases, const Limits& limits) {
    std::vector<ScoredCase> scored;
    for (const LimitCase& c : cases)
        scored.push_back({c.truth, answer_of(*c.findings, limits), c.over_limit});
    return merits_of(scored);
}

Limits choose_limits(std::span<const LimitCase> cases) {
    Limits best;
    double highest = objective(merits_with(cases, best));
    for (int round = 0; round < max_rounds; ++round) {
        const double before = highest;
        for (const Choice& choice : choices)
            for (const double value : choice.values) {
                Limits tried = best;
                tried.*choice.limit = value;
                if (const double found = objective(merits_with(cases, tried)); found > highest + 1e-9) {
                    highest = found;
                    best = tried;
                }
            }
        if (highest == before) break;
    }
    return best;
}

std::map<std::string_view, double> named_limits(const Limits& limits) {
    std::map<std::string_view, double> values;
    for (const Choice& choice : choices) values[choice.name] = limits.*choice.limit;
    return values;
}

}  // namespace mcdem::challenge
