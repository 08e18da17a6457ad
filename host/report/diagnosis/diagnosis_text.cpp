#include "report/diagnosis/diagnosis_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "report/diagnosis/diagnosis_where.h"
#include "report/diagnosis/diagnosis_words.h"
#include "report/page/labels.h"

namespace mcdem::inline report {
namespace {

constexpr std::size_t max_limits = 5;
constexpr std::size_t max_remark_length = 160;

const Cause* leader_of(const Diagnosis& diagnosis) {
    if (!diagnosis.causes.empty()) return &diagnosis.causes.front();
    return diagnosis.ranking.empty() ? nullptr : &diagnosis.ranking.front();
}

/// The members of the leading effect's group, with their amplitudes if known.
std::vector<std::string> members_of(const Diagnosis& diagnosis, const Cause& leader) {
    std::vector<std::string> members;
    for (const auto& name : leader.group) {
        const auto is_it = [&](const Cause& cause) { return cause.effect == name; };
        const auto cause = std::ranges::find_if(diagnosis.causes, is_it);
        const auto ranked = std::ranges::find_if(diagnosis.ranking, is_it);
        if (cause != diagnosis.causes.end())
            members.push_back(cause_words(*cause));
        else
            members.push_back(ranked != diagnosis.ranking.end() ? cause_words(*ranked) : words_of(name));
    }
    return members;
}

/// A second effect that acts together with the leading one, as a continuation of a sentence; empty if there
/// is none.
std::string together_with(const Diagnosis& diagnosis) {
    const auto added = added_causes(diagnosis);
    std::vector<std::string> parts;
    for (std::size_t i = 1; i < added.size(); ++i) parts.push_back(cause_words(added[i]));
    return parts.empty() ? "" : " together with " + listed(parts);
}

/// Effects that cannot be distinguished from the leading one, as a continuation; empty if there are none.
std::string not_told_from(const Cause& leader) {
    std::vector<std::string> parts;
    for (const auto& name : leader.group)
        if (name != leader.effect) parts.push_back(words_of(name));
    return parts.empty() ? "" : ", which these data cannot tell from " + listed(parts);
}

/// Settings that the diagnosis has refined, as a continuation; empty if there are none.
std::string refined(const Diagnosis& diagnosis) {
    std::string text;
    for (const auto& refinement : diagnosis.refinements)
        if (refinement.done) text += ", with " + refinement_words(refinement);
    return text;
}

/// Settings that must still be refined; empty if none are known.
std::string to_refine(const Diagnosis& diagnosis) {
    for (const auto& refinement : diagnosis.refinements)
        if (!refinement.done) return "; set " + refinement_words(refinement);
    return "";
}

std::vector<std::string> differing_packings(const Diagnosis& diagnosis) {
    std::vector<std::string> names;
    for (const auto& packing : diagnosis.packings)
        if (packing.differs) names.push_back(one_line(packing.experiment));
    return names;
}

/// Agreement of the packings, as a continuation; empty for a single packing.
std::string packings_words(const Diagnosis& diagnosis) {
    if (diagnosis.packings.empty()) return "";
    const auto differing = differing_packings(diagnosis);
    const bool all = differing.size() == diagnosis.packings.size();
    return fmt::format("; {} packings together, {}", diagnosis.packings.size(),
                       differing.empty() ? "which agree"
                       : all
                           ? "which differ from one another by more than noise"
                           : "of which " + listed(differing) + " differs from the others by more than noise");
}

std::string gap_line(const Diagnosis& diagnosis) {
    const auto packings = packings_words(diagnosis);
    const bool at_one_place = diagnosis.p_value > 2 * std::min(diagnosis.p_omnibus, diagnosis.p_directed);
    if (!diagnosis.detected)
        return fmt::format("none that these data show{}: {} ({}){}.", refined(diagnosis),
                           at_one_place
                               ? "they differ at one displacement only, where grains may have rearranged"
                               : "noise alone gives differences like these",
                           p_words(diagnosis.p_value), packings);
    return fmt::format(
        "yes: simulation and experiment differ by more than noise and calibration account for{} ({}){}.",
        refined(diagnosis), p_words(diagnosis.p_value), packings);
}

/// The reduction required to name an effect, as a continuation.
std::string needed_words(const Explanation& explanation) {
    if (explanation.reduction < 0) return "";
    if (explanation.placebo > 0.5)
        return ", but random effects (placebo) take away up to " + percent(explanation.placebo);
    const auto needed = percent(explanation.needed);
    return needed == percent(explanation.reduction) ? ", a little less than is needed to name it"
                                                    : ", and " + needed + " would be needed to name it";
}

std::string unknown_line(const Diagnosis& diagnosis) {
    auto text = (no_effect_can_be_named(diagnosis) ? "these data cannot tell an effect from chance ("
                                                   : "no tested effect explains it (") +
                library_words(diagnosis) + ")";
    if (const auto* best = leader_of(diagnosis); best && diagnosis.explanation)
        text += fmt::format("; the best one, {}{}, has a probability of {}: it {}{}", cause_words(*best),
                            together_with(diagnosis), percent(best->confidence), reduction_words(diagnosis),
                            needed_words(*diagnosis.explanation));
    return text + ".";
}

std::string listed_suspects(const Diagnosis& diagnosis) {
    std::vector<std::string> words;
    for (const auto& suspect : suspects_of(diagnosis)) words.push_back(suspect_words(suspect));
    return listed(words);
}

std::string calibration_line(const Diagnosis& diagnosis) {
    auto text = std::string(
        "consistent with an error of a stated parameter, which must be excluded before an effect is named");
    if (const auto suspects = listed_suspects(diagnosis); !suspects.empty()) text += ": " + suspects;
    if (!diagnosis.causes.empty()) text += not_told_from(diagnosis.causes.front());
    return text + ".";
}

std::string which_line(const Diagnosis& diagnosis) {
    const auto* leader = leader_of(diagnosis);
    switch (diagnosis.verdict) {
        case Verdict::no_gap:
            return "no effect is needed.";
        case Verdict::unknown_effect:
            return unknown_line(diagnosis);
        case Verdict::not_converged:
            return fmt::format(
                "consistent with a numerical error of the simulation, which must be removed before an effect "
                "is named: {}{}{}.",
                leader ? words_of(leader->effect) : "a setting", together_with(diagnosis),
                to_refine(diagnosis));
        case Verdict::calibration_suspect:
            return calibration_line(diagnosis);
        case Verdict::effect:
            if (!leader) break;
            return fmt::format("consistent with {}{}, with a probability of {} ({}).", cause_words(*leader),
                               together_with(diagnosis), percent(leader->confidence),
                               library_words(diagnosis));
        case Verdict::group:
            if (!leader) break;
            return fmt::format("consistent with any of {}{}; these data cannot tell them apart.",
                               listed(members_of(diagnosis, *leader)), together_with(diagnosis));
    }
    return "no effect is named.";
}

std::string what_is_added(const Diagnosis& diagnosis) {
    if (diagnosis.verdict == Verdict::calibration_suspect) return "correcting the parameter";
    if (diagnosis.verdict == Verdict::not_converged) return "refining the setting";
    return "adding " + added_words(diagnosis);
}

std::string data_words(const Diagnosis& diagnosis) {
    if (!diagnosis.explanation->held_out) return " (of the whole gap: the held-out data alone show none)";
    const auto held_out = diagnosis.gap_reduction
                              ? shortened(one_line(diagnosis.gap_reduction->held_out), max_remark_length)
                              : "";
    return " in held-out data" + (held_out.empty() ? "" : " (" + held_out + ")");
}

std::string how_far_line(const Diagnosis& diagnosis) {
    if (!diagnosis.explanation)
        return diagnosis.verdict == Verdict::no_gap ? "there is nothing to explain."
                                                    : "not known: nothing was tried.";
    const auto& explanation = *diagnosis.explanation;
    auto text = fmt::format("{} {}{}, {}; random effects (placebo) take away at most {}; {}",
                            what_is_added(diagnosis), reduction_words(diagnosis), data_words(diagnosis),
                            explanation.simulated ? "from full simulations" : "estimated from signatures",
                            percent(explanation.placebo), remainder_words(explanation));
    if (!diagnosis.check_first.empty()) text += ", with the shifts of parameters under First";
    if (const auto& gap_reduction = diagnosis.gap_reduction;
        gap_reduction && gap_reduction->before > 0 && explanation.held_out)
        text += fmt::format("; the signatures had predicted {} (90 % interval: {:.0f} to {})",
                            percent(gap_reduction->fraction), gap_reduction->interval[0] * 100,
                            percent(gap_reduction->interval[1]));
    return text + ".";
}

/// Finite limits of the candidates with the highest scores; without a ranking, in the given order.
std::vector<std::string> limits_that_matter(const Diagnosis& diagnosis) {
    auto limits = diagnosis.detection_limits;
    const auto rank = [&](const DetectionLimit& limit) {
        return std::ranges::find_if(diagnosis.ranking,
                                    [&](const Cause& cause) { return cause.effect == limit.effect; }) -
               diagnosis.ranking.begin();
    };
    std::ranges::stable_sort(
        limits, [&](const DetectionLimit& a, const DetectionLimit& b) { return rank(a) < rank(b); });
    std::vector<std::string> words;
    for (const auto& limit : limits)
        if (std::isfinite(limit.minimum_amplitude))
            words.push_back(words_of(limit.effect) + " from " + amount(limit.minimum_amplitude, limit.unit));
    return words;
}

std::vector<std::string> never_shown(const Diagnosis& diagnosis) {
    std::vector<std::string> words;
    for (const auto& limit : diagnosis.detection_limits)
        if (!std::isfinite(limit.minimum_amplitude)) words.push_back(words_of(limit.effect));
    return words;
}

std::string no_gap_limits(const Diagnosis& diagnosis) {
    const auto limits = limits_that_matter(diagnosis);
    if (limits.empty()) return "smaller effects than these data can show may be there.";
    return "smaller ones may be there: in four of five cases these data would show " +
           listed(limits, max_limits);
}

std::string limits_line(const Diagnosis& diagnosis) {
    std::string text;
    if (diagnosis.verdict == Verdict::no_gap)
        text = no_gap_limits(diagnosis);
    else if (diagnosis.verdict == Verdict::unknown_effect)
        text = "an unknown effect, or several at once, may be the cause";
    else if (diagnosis.verdict == Verdict::not_converged)
        text =
            "an effect that looks like this setting would give the same data, and must be distinguished "
            "from it first";
    else if (diagnosis.verdict == Verdict::calibration_suspect)
        text = "an effect that looks like this parameter would give the same data";
    else
        text = "consistent is not proven: an effect outside the library may look the same";
    while (text.ends_with('.')) text.pop_back();
    if (!differing_packings(diagnosis).empty())
        text += "; a difference between packings is not an effect that acts on all of them";
    const auto never = never_shown(diagnosis);
    if (!never.empty()) text += "; these data can never show " + listed(never, max_limits);
    if (const auto missing = missing_words(diagnosis.missing_bins); !missing.empty()) text += "; " + missing;
    if (!diagnosis.not_measured.empty())
        text += "; not measured: " + shortened(one_line(diagnosis.not_measured.front()), max_remark_length);
    while (text.ends_with('.')) text.pop_back();
    return text + ".";
}

std::string next_line(const Diagnosis& diagnosis) {
    if (diagnosis.next.empty()) return "no measurement whose benefit can be predicted would help.";
    std::string text;
    for (const auto& step : diagnosis.next) text += (text.empty() ? "" : "; ") + one_line(next_words(step));
    while (text.ends_with('.')) text.pop_back();
    return text + ".";
}

/// The reduction of the named explanation, as a continuation.
std::string taken_away(const Diagnosis& diagnosis) {
    if (!diagnosis.explanation) return "";
    const bool pair = added_causes(diagnosis).size() > 1;
    const auto* added = diagnosis.verdict == Verdict::group ? "the first of them" : pair ? "both" : "it";
    return fmt::format("; adding {} takes away {} of the gap", added,
                       percent(diagnosis.explanation->reduction));
}

std::string headline_of_verdict(const Diagnosis& diagnosis) {
    const bool pair = !together_with(diagnosis).empty();
    switch (diagnosis.verdict) {
        case Verdict::no_gap:
            return "No detectable gap";
        case Verdict::effect:
            return fmt::format("A gap; {} {}", pair ? "a pair of effects" : "one effect",
                               reduction_words(diagnosis));
        case Verdict::group:
            return fmt::format("A gap; one of several effects {}", reduction_words(diagnosis));
        case Verdict::unknown_effect:
            return no_effect_can_be_named(diagnosis) ? "A gap whose cause these data cannot tell"
                                                     : "A gap that no tested effect explains";
        case Verdict::not_converged:
            return "The simulation is not converged";
        case Verdict::calibration_suspect:
            break;
    }
    return "A stated parameter is suspect";
}

std::string sentence_of_verdict(const Diagnosis& diagnosis) {
    const auto* leader = leader_of(diagnosis);
    switch (diagnosis.verdict) {
        case Verdict::no_gap:
            return fmt::format("No gap is detectable{} ({}).", refined(diagnosis),
                               p_words(diagnosis.p_value));
        case Verdict::effect:
            return "The gap is consistent with " + (leader ? cause_words(*leader) : "one effect") +
                   together_with(diagnosis) + taken_away(diagnosis) + ".";
        case Verdict::group:
            return "The gap is consistent with any of " +
                   (leader ? listed(words_of_all(leader->group)) : "several effects") +
                   ", which these data cannot tell apart" + taken_away(diagnosis) + ".";
        case Verdict::unknown_effect:
            return fmt::format("There is a gap {} ({})",
                               no_effect_can_be_named(diagnosis) ? "whose cause these data cannot tell"
                                                                 : "that no tested effect explains",
                               library_words(diagnosis)) +
                   (diagnosis.explanation ? "; the best one " + reduction_words(diagnosis) : "") + ".";
        case Verdict::not_converged:
            return fmt::format("The gap is consistent with a simulation that is not converged{}.",
                               to_refine(diagnosis));
        case Verdict::calibration_suspect:
            break;
    }
    const auto suspects = listed_suspects(diagnosis);
    return "The gap is consistent with an error of a stated parameter" +
           (suspects.empty() ? "" : ": " + suspects) + ".";
}

}  // namespace

std::string verdict_headline(const Diagnosis& diagnosis) {
    const auto headline = headline_of_verdict(diagnosis);
    if (diagnosis.check_first.empty()) return headline;
    const auto& farthest = diagnosis.check_first.front();
    const auto others = diagnosis.check_first.size() - 1;
    return fmt::format("Check first: {} ({}){}. {}", words_of(farthest.name), sigma_words(farthest),
                       others == 0 ? "" : fmt::format(" and {} more", others), headline);
}

std::string verdict_sentence(const Diagnosis& diagnosis) {
    auto check = check_words(diagnosis);
    if (check.empty()) return sentence_of_verdict(diagnosis);
    check[0] = 'C';
    return check + ". " + sentence_of_verdict(diagnosis);
}

std::vector<VerdictLine> verdict_lines(const Diagnosis& diagnosis) {
    std::vector<VerdictLine> lines;
    if (!diagnosis.check_first.empty()) lines.push_back({"First", check_words(diagnosis) + "."});
    lines.push_back({"Gap", gap_line(diagnosis)});
    lines.push_back({"Where", where_line(diagnosis)});
    lines.push_back({"Which", which_line(diagnosis)});
    lines.push_back({"How far", how_far_line(diagnosis)});
    lines.push_back({"Limits", limits_line(diagnosis)});
    lines.push_back({"Next", next_line(diagnosis)});
    return lines;
}

std::string diagnosis_text(const Diagnosis& diagnosis) {
    std::string text;
    for (const auto& [about, says] : verdict_lines(diagnosis))
        text += fmt::format("{:<9}{}\n", about + ":", says);
    return text;
}

}  // namespace mcdem::report
