#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "challenge/figure_values.h"
#include "challenge/score.h"
#include "challenge/truth.h"
#include "cli/run/figures.h"
#include "cli/shell/commands.h"
#include "cli/shell/messages.h"
#include "cli/shell/progress.h"
#include "cli/shell/standard_streams.h"
#include "cli/shell/text_table.h"
#include "core/errors.h"
#include "core/look.h"
#include "core/output_file.h"
#include "io/result_folder.h"

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
    void number(const std::string& name, double first, double second, const std::string& required,
                const std::string& is_met) {
        table_.rows.push_back(
            {name, fmt::format("{:.2f}", second), required, is_met, fmt::format("{:.2f}", first)});
    }

private:
    void add(const std::string& name, Share Merits::*merit, const std::string& required,
             const std::string& is_met) {
        const Share& second = arm_.second.*merit;
        table_.rows.push_back({name, with_interval(second), required, second.of > 0 ? is_met : "",
                               with_interval(arm_.first.*merit)});
    }
    const ArmScore& arm_;
    TextTable& table_;
};

void add_gap_reduction(const GapReductionScore& gap_reduction, TextTable& table) {
    if (gap_reduction.cases == 0) return;
    table.rows.push_back({"gap reduction: median |predicted - simulated|",
                          fmt::format("{:.2f}", gap_reduction.median_error), "at most 0.10",
                          met(gap_reduction.median_error <= 0.10),
                          fmt::format("{} cases, all", gap_reduction.cases)});
    table.rows.push_back({"gap reduction: simulated within the 90 % interval",
                          with_interval(gap_reduction.covered), "at least 80 %",
                          met(gap_reduction.covered.value() >= 0.80), "all"});
}

/// Mean square error of always stating the share of the other half.
double base_rate_brier(const Merits& m, double rate) {
    const double right = m.right_leaders.value();
    return right * (1 - rate) * (1 - rate) + (1 - right) * rate * rate;
}

/// Figures of merit of the whole method with 95 % intervals and targets, for both halves.
TextTable table_of_merits(const ChallengeScore& score) {
    const Bars bars;
    const ArmScore& arm = score.arms.front();
    TextTable table;
    table.columns = {{"figure of merit", Align::left},
                     {"scored half", Align::left},
                     {"required", Align::left},
                     {"met"},
                     {"half used to set limits", Align::left}};
    MeritRows rows(arm, table);
    rows.at_most("no effect: a gap is claimed", &Merits::false_alarms, bars.false_alarms);
    rows.share("one effect: detected", &Merits::detected);
    rows.share("one effect, 1.5 limits or more: detected", &Merits::detected_clear);
    rows.at_least(".. of these detected: named first", &Merits::led_by_truth, bars.led_by_truth);
    rows.at_least(".. of these detected: in the group named", &Merits::truth_in_group, bars.truth_in_group);
    rows.number(".. of these detected: mean size of the group", arm.first.group_size, arm.second.group_size,
                fmt::format("at most {}", bars.group_size), met(arm.second.group_size <= bars.group_size));
    rows.at_most("effect outside the library: an effect is named", &Merits::named_unknown,
                 bars.named_unknown);
    rows.at_most("parameter far outside its uncertainty: an effect is named", &Merits::named_outside_prior,
                 bars.named_outside_prior);
    rows.share(".. : verdict calibration_suspect", &Merits::suspected);
    rows.share("two effects: named first is one of them", &Merits::pair_led);
    rows.share("two effects: both named", &Merits::pair_found);
    const double base = base_rate_brier(arm.second, arm.first.right_leaders.value());
    rows.number("Brier score of the probabilities of all leading effects", arm.first.brier, arm.second.brier,
                fmt::format("less than the base rate's {:.2f}", base), met(arm.second.brier < base));
    add_gap_reduction(score.gap_reduction, table);
    table.notes.push_back(
        "95 % intervals after Wilson (1927). Limits were set on one half of the packings and scored on the "
        "other half.");
    return table;
}

/// All methods on the scored half.
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
            {"right_leaders", share_json(m.right_leaders)},
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

struct ScoreCommand {
    std::string challenge, out, truth;
    bool no_figures = false;
};

void print(const ChallengeScore& score) {
    print_out("{}\n{}\n", to_text(table_of_merits(score), TableFormat::terminal),
              to_text(table_of_arms(score), TableFormat::terminal));
}

void expect_folder(const std::filesystem::path& diagnoses) {
    if (!is_folder(diagnoses))
        throw InputError(diagnoses.string() + ": must be the folder of the diagnoses, got none");
}

void score(const ScoreCommand& command) {
    const std::filesystem::path folder = command.challenge, out = command.out;
    const OpenChallenge open = read_open_challenge(folder);
    const Challenge truth =
        open_truth(command.truth.empty() ? folder / "truth.json" : std::filesystem::path(command.truth),
                   open.sealed_sha256);
    expect_folder(out);
    const FolderLock lock = open_output_folder(out);
    expect_replaceable(out / "score.json", FileKind::score);
    expect_replaceable(out / "score.md", FileKind::score_page);
    ChallengeScore score;
    {
        Progress progress(stderr, progress_style(stderr));
        score = score_challenge(truth, open, out, [&](double fraction) { progress.show(fraction); });
    }
    for (const std::string& problem : score.not_diagnosed) spdlog::warn("not diagnosed: {}", problem);
    print(score);
    replace_own(out / "score.json", FileKind::score, score_json(score));
    replace_own(out / "score.md", FileKind::score_page, score_markdown(score));
    print_out("wrote {}\nwrote {}\n", (out / "score.json").string(), (out / "score.md").string());
    if (command.no_figures) return;
    for (const auto& figure : draw_if_possible([&] { return draw_figures(out, score_figure_values(score)); }))
        print_out("wrote {}\n", figure.string());
}

}  // namespace

void add_challenge_score(CLI::App& challenge, int&) {
    auto* sub = challenge.add_subcommand("score", "Compare the diagnoses with the truth");
    auto command = std::make_shared<ScoreCommand>();
    sub->add_option("CHALLENGE", command->challenge, "Folder of the challenge")->required();
    sub->add_option("DIAGNOSES", command->out, "Folder of the diagnoses; the score is written to it")
        ->required();
    sub->add_option("--truth", command->truth, "File with the truth; default: CHALLENGE/truth.json")
        ->type_name("FILE");
    sub->add_flag("--no-figures", command->no_figures, "Do not draw figures");
    sub->footer(
        "A truth file whose SHA-256 is not the one in challenge.json is refused.\n"
        "Example:\n"
        "  mcdem challenge score out/challenge out/diagnoses");
    sub->callback([command] { score(*command); });
}

}  // namespace mcdem::cli
