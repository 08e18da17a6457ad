#include "cli/challenge/challenge_tables.h"

#include <fmt/format.h>

#include "challenge/figure_values.h"
#include "challenge/truth.h"

namespace mcdem::inline cli {
namespace {

std::string percent(double value) { return fmt::format("{:.0f} %", 100 * value); }

/// "36 of 40: 90 % [77, 96]".
std::string with_interval(const Share& share) {
    if (share.of == 0) return "-";
    const auto [low, high] = wilson_interval(share.hits, share.of);
    return fmt::format("{} of {}: {:.0f} % [{:.0f}, {:.0f}]", share.hits, share.of, 100 * share.value(),
                       100 * low, 100 * high);
}

std::string short_share(const Share& share) {
    return share.of > 0 ? fmt::format("{}/{}", share.hits, share.of) : "-";
}

std::string met(bool is_met) { return is_met ? "yes" : "NO"; }

/// One line of the table of merits: shares of both halves, and the target.
class MeritRows {
public:
    MeritRows(const ArmScore& arm, TextTable& table) : arm_(arm), table_(table) {}

    void share(const std::string& name, Share Merits::*merit) { add(name, merit, "", ""); }
    void at_most(const std::string& name, Share Merits::*merit, double bar) {
        add(name, merit, "at most " + percent(bar), met((arm_.second.*merit).value() <= bar));
    }
    void at_least(const std::string& name, Share Merits::*merit, double bar) {
        add(name, merit, "at least " + percent(bar), met((arm_.second.*merit).value() >= bar));
    }
    void number(const std::string& name, double first, double second, const std::string& asked,
                const std::string& is_met) {
        table_.rows.push_back(
            {name, fmt::format("{:.2f}", second), asked, is_met, fmt::format("{:.2f}", first)});
    }

private:
    void add(const std::string& name, Share Merits::*merit, const std::string& asked,
             const std::string& is_met) {
        const Share& second = arm_.second.*merit;
        table_.rows.push_back({name, with_interval(second), asked, second.of > 0 ? is_met : "",
                               with_interval(arm_.first.*merit)});
    }
    const ArmScore& arm_;
    TextTable& table_;
};

void add_gap_reduction(const GapReductionScore& gap_reduction, TextTable& table) {
    if (gap_reduction.cases == 0) return;
    table.rows.push_back({"shrink: median |predicted - realised|",
                          fmt::format("{:.2f}", gap_reduction.median_error), "at most 0.10",
                          met(gap_reduction.median_error <= 0.10),
                          fmt::format("{} cases, all", gap_reduction.cases)});
    table.rows.push_back({"shrink: realised within the 90 % interval", with_interval(gap_reduction.covered),
                          "at least 80 %", met(gap_reduction.covered.value() >= 0.80), "all"});
}

/// Mean square error of always stating the share of the other half.
double base_rate_brier(const Merits& m, double rate) {
    const double right = m.right_where_named.value();
    return right * (1 - rate) * (1 - rate) + (1 - right) * rate * rate;
}

}  // namespace

TextTable table_of_merits(const ChallengeScore& score) {
    const Bars bars;
    const ArmScore& arm = score.arms.front();
    TextTable table;
    table.columns = {{"figure of merit", Align::left},
                     {"scored half", Align::left},
                     {"asked", Align::left},
                     {"met"},
                     {"half for the limits", Align::left}};
    MeritRows rows(arm, table);
    rows.at_most("no effect: a gap is claimed", &Merits::false_alarms, bars.false_alarms);
    rows.share("one effect: detected", &Merits::detected);
    rows.share("one effect, 1.5 limits or more: detected", &Merits::detected_clear);
    rows.at_least(".. of these detected: named first", &Merits::led_by_truth, bars.led_by_truth);
    rows.at_least(".. of these detected: in the group named", &Merits::truth_in_group, bars.truth_in_group);
    rows.number(".. of these detected: mean size of the group", arm.first.group_size, arm.second.group_size,
                fmt::format("at most {}", bars.group_size), met(arm.second.group_size <= bars.group_size));
    rows.at_most("unknown effect: a known one is named", &Merits::named_unknown, bars.named_unknown);
    rows.at_most("nuisance outside its prior: an effect is named", &Merits::named_outside_prior,
                 bars.named_outside_prior);
    rows.share(".. : the calibration is suspected", &Merits::suspected);
    rows.share("two effects: named first is one of them", &Merits::pair_led);
    rows.share("two effects: both named", &Merits::pair_found);
    const double base = base_rate_brier(arm.second, arm.first.right_where_named.value());
    rows.number("Brier score of the confidence", arm.first.brier, arm.second.brier,
                fmt::format("less than the base rate's {:.2f}", base), met(arm.second.brier < base));
    add_gap_reduction(score.gap_reduction, table);
    table.notes.push_back(
        "95 % intervals after Wilson (1927). Limits were set on one half of the packings, the score is the "
        "other's.");
    return table;
}

TextTable table_of_arms(const ChallengeScore& score) {
    TextTable table;
    table.columns = {{"method", Align::left}, {"false alarms"},    {"detected"},   {"named, of all"},
                     {"named first, clear"},  {"in group, clear"}, {"group size"}, {"unknown named"},
                     {"outside prior named"}, {"pairs found"},     {"Brier"}};
    for (const ArmScore& arm : score.arms) {
        const Merits& m = arm.second;
        table.rows.push_back({arm.name, short_share(m.false_alarms), short_share(m.detected),
                              short_share(m.named), short_share(m.led_by_truth),
                              short_share(m.truth_in_group), fmt::format("{:.2f}", m.group_size),
                              short_share(m.named_unknown), short_share(m.named_outside_prior),
                              short_share(m.pair_found), fmt::format("{:.3f}", m.brier)});
        table.notes.push_back(fmt::format("{}: {}{}", arm.name, arm.meaning,
                                          arm.has_limits ? ", its limits set on the first half" : ""));
    }
    table.notes.push_back("clear: 1.5 detection limits of the whole method or more, and detected");
    return table;
}

namespace {

/// Detected and named cases by effect.
TextTable table_of_effects(const ChallengeScore& score) {
    TextTable table;
    table.columns = {{"effect", Align::left}, {"detected"}, {"named first"}};
    const Merits& m = score.arms.front().second;
    for (const auto& [effect, share] : m.detected_by_effect)
        table.rows.push_back({effect, short_share(share), short_share(m.named_by_effect.at(effect))});
    return table;
}

/// Cases with unknown effects in which an effect was named, by unknown effect.
TextTable table_of_unknown(const ChallengeScore& score) {
    TextTable table;
    table.columns = {
        {"outside the library", Align::left}, {"an effect is named, scored half"}, {"other half"}};
    const Merits &first = score.arms.front().first, &second = score.arms.front().second;
    for (const auto& [name, share] : second.named_by_unknown) {
        const auto other = first.named_by_unknown.find(name);
        table.rows.push_back({name, short_share(share),
                              other == first.named_by_unknown.end() ? "-" : short_share(other->second)});
    }
    return table;
}

/// Limits set with the first half, and the defaults.
TextTable table_of_limits(const ChallengeScore& score) {
    TextTable table;
    table.columns = {{"limit", Align::left}, {"set"}, {"default"}};
    const auto defaults = named_limits(Limits{});
    for (const auto& [name, value] : named_limits(score.arms.front().limits))
        table.rows.push_back(
            {std::string(name), fmt::format("{:g}", value), fmt::format("{:g}", defaults.at(name))});
    return table;
}

}  // namespace

std::string score_markdown(const ChallengeScore& score) {
    std::string text = fmt::format("# Score of the challenge\n\n{} cases.\n", score.cases);
    for (const auto& [title, table] : {std::pair{"Figures of merit", table_of_merits(score)},
                                       {"Methods, on the scored half", table_of_arms(score)},
                                       {"By effect, on the scored half", table_of_effects(score)},
                                       {"Unknown effects", table_of_unknown(score)},
                                       {"Limits", table_of_limits(score)}})
        text += fmt::format("\n## {}\n\n{}\n", title, to_text(table, TableFormat::markdown));
    if (!score.not_diagnosed.empty()) text += "\n## Not diagnosed\n\n";
    for (const std::string& problem : score.not_diagnosed) text += "- " + problem + "\n";
    return text;
}

}  // namespace mcdem::cli
