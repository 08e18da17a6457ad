#include "report/diagnosis/diagnosis_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "diagnose/infer/effects.h"
#include "report/page/labels.h"

namespace mcdem::inline report {
namespace {

/// Names that are not of effects.
const std::map<std::string, std::string>& special_words() {
    static const std::map<std::string, std::string> words{
        {"strain_offset", "zero of the displacement"},
        {"non_affine", "non-affine displacement"},
        {"modulus", "modulus of the grains"},
    };
    return words;
}

/// Unit in files, conversion factor, displayed unit.
struct ShownUnit {
    std::string unit;
    double factor;
    std::string shown;
};

ShownUnit shown_unit(const std::string& unit) {
    static const std::vector<ShownUnit> units{
        {"m", 1e3, "mm"},      {"N", 1e3, "mN"},     {"J/m2", 1e3, "mJ/m²"}, {"Pa", 1e-3, "kPa"},
        {"s", 1e3, "ms"},      {"m/N", 1e3, "mm/N"}, {"relative", 100, "%"}, {"1", 1, ""},
        {"kg/m3", 1, "kg/m³"}, {"J/m3", 1, "J/m³"},
    };
    for (const auto& known : units)
        if (known.unit == unit) return known;
    return {unit, 1, one_line(unit)};
}

std::string with_unit(const std::string& number, const std::string& unit) {
    return unit.empty() ? number : number + " " + unit;
}

/// Number of decimals that shows the first two digits of `error`.
int decimals_for(double error) {
    return std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 0, 12);
}

/// Texts for the two signs of an amplitude, after its absolute value.
struct Directions {
    std::string above, below;
};
const std::map<std::string, Directions>& directions() {
    static const Directions of_the_scene{"higher than in the scene", "lower than in the scene"},
        stated{"higher than stated", "lower than stated"}, read{"too high", "too low"};
    static const std::map<std::string, Directions> all{
        {"friction", of_the_scene},
        {"wall_friction", of_the_scene},
        {"gamma", of_the_scene},
        {"modulus", stated},
        {"strain_offset", stated},
        {"force_threshold", stated},
        {"buoyancy", {"denser than stated", "lighter than stated"}},
        {"diameter_error", {"larger than stated", "smaller than stated"}},
        {"stiffening", {"stiffer than Hertz's law", "softer than Hertz's law"}},
        {"plate_tilt", {"rising along x", "falling along x"}},
        {"plate_tilt_y", {"rising along y", "falling along y"}},
        {"force_bias", read},
        {"gauge_drift", read},
        {"zero_drift", read},
        {"gauge_hysteresis", read},
        {"position_bias", read},
    };
    return all;
}

double pull(const NuisanceFit& fit) { return fit.prior > 0 ? std::fabs(fit.value) / fit.prior : 0; }

}  // namespace

std::string words_of(const std::string& name) {
    const auto found = special_words().find(name);
    if (found != special_words().end()) return found->second;
    if (const Effect* effect = find_effect(name); effect && !effect->words.empty())
        return std::string(effect->words);
    auto words = one_line(name);
    std::ranges::replace(words, '_', ' ');
    return words;
}

std::string listed(const std::vector<std::string>& parts, std::size_t most) {
    const std::size_t shown = std::min(parts.size(), most);
    std::string text;
    for (std::size_t i = 0; i < shown; ++i) {
        const bool last = i + 1 == parts.size();
        text += (i == 0 ? "" : last ? " and " : ", ") + parts[i];
    }
    return shown < parts.size() ? fmt::format("{} and {} more", text, parts.size() - shown) : text;
}

std::string amount(double value, const std::string& unit) {
    if (!std::isfinite(value)) return no_number;
    const auto& [_, factor, shown] = shown_unit(unit);
    return with_unit(fmt::format("{:.3g}", value * factor), shown);
}

std::string amount(double value, double error, const std::string& unit, Sign sign) {
    if (!std::isfinite(value) || std::isinf(error)) return no_number;
    const auto& [_, factor, shown] = shown_unit(unit);
    const auto plus = sign == Sign::always && value > 0 ? "+" : "";
    if (!(error > 0) || !std::isfinite(error)) return fmt::format("{}{}", plus, amount(value, unit));
    const int decimals = decimals_for(error * factor);
    return with_unit(
        fmt::format("{}{:.{}f} ± {:.{}f}", plus, value * factor, decimals, error * factor, decimals), shown);
}

std::string percent(double fraction) {
    if (!std::isfinite(fraction)) return no_number;
    if (fraction > 0 && fraction < 0.005) return "< 1 %";
    return fmt::format("{:.0f} %", std::round(fraction * 100) + 0.0);  // avoids "-0"
}

std::string p_words(double p) {
    if (!std::isfinite(p)) return "p = " + no_number;
    return p < 1e-4 ? "p < 0.0001" : fmt::format("p = {:.2g}", p);
}

std::string displacement_words(const std::array<double, 2>& displacement) {
    const auto [from, to] = displacement;
    if (from == 0 && to == 0) return "";
    if (from == to) return fmt::format("{:.3g} mm", from * 1e3);
    return fmt::format("{:.3g} to {:.3g} mm", from * 1e3, to * 1e3);
}

std::string phase_words(const std::string& phase) {
    return phase.empty() ? "both phases" : one_line(phase) + "ing";
}

namespace {

/// "12 % higher than simulated"; only for the magnitude of forces, whose observables are logarithms.
std::string difference_words(const WhereEntry& entry) {
    const bool is_force = entry.observable == "top_force" || entry.observable == "mean_force";
    const std::string size =
        is_force && entry.difference != 0 ? percent(std::fabs(std::expm1(entry.difference))) + " " : "";
    return size + (entry.z_score > 0 ? "higher" : "lower") + " than simulated";
}

}  // namespace

std::string where_words(const WhereEntry& entry) {
    auto text = words_of(entry.observable);
    if (!entry.phase.empty()) text += " while " + phase_words(entry.phase);
    for (const auto& part : {entry.region, entry.force_class})
        if (part && !part->empty()) text += ", " + words_of(*part);
    const auto displacement = displacement_words(entry.displacement);
    if (!displacement.empty()) text += ", at a displacement of " + displacement;
    return text + ": " + difference_words(entry) +
           fmt::format(" ({:.1f} sigma, {:.1f} after recalibration)", entry.z_score, entry.z_score_refitted);
}

std::string directed_amount(const std::string& name, double value, double error, const std::string& unit) {
    if (name == "modulus" && unit == "relative") {  // of the logarithm
        error *= std::exp(value);
        value = std::expm1(value);
    }
    const auto found = directions().find(name);
    if (found == directions().end() || value == 0 || !std::isfinite(value) || std::isinf(error))
        return amount(value, error, unit);
    return amount(std::fabs(value), error, unit) + " " +
           (value > 0 ? found->second.above : found->second.below);
}

std::string cause_words(const Cause& cause) {
    return words_of(cause.effect) + " (" +
           directed_amount(cause.effect, cause.amplitude, cause.amplitude_error, cause.unit) +
           (cause.at_limit ? ", or more: it is at the limit of the range tried)" : ")");
}

std::vector<Cause> added_causes(const Diagnosis& diagnosis) {
    std::vector<Cause> added;
    for (const auto& cause : diagnosis.causes)
        if (added.empty() || std::ranges::count(added.front().group, cause.effect) == 0)
            added.push_back(cause);
    return added;
}

std::string added_words(const Diagnosis& diagnosis) {
    std::vector<std::string> words;
    for (const auto& cause : added_causes(diagnosis)) words.push_back(words_of(cause.effect));
    return words.empty() ? "the effect" : listed(words);
}

std::string library_words(const Diagnosis& diagnosis) {
    const auto count = diagnosis.detection_limits.size();
    if (count == 0) return "no effect could be tested";
    return fmt::format("{} effect{} tested", count, count == 1 ? " was" : "s were");
}

std::string remainder_words(const Explanation& explanation) {
    const auto& without = explanation.without;
    if (!explanation.leaves_more_than_noise)
        return fmt::format(
            "the remainder cannot be distinguished from noise{}",
            without.empty() ? "" : ", except at " + without + ", where grains may have rearranged");
    const double left = std::max(0.0, explanation.remainder());
    return fmt::format("{} of the gap remains unexplained ({})", left >= 1 ? "all" : percent(left),
                       p_words(explanation.remainder_p));
}

std::string refinement_words(const Refinement& refinement) {
    return one_line(fmt::format("{} = {:.3g}{} instead of {:.3g}", refinement.key, refinement.to,
                                refinement.unit.empty() ? "" : " " + refinement.unit, refinement.from));
}

std::string next_words(const NextStep& step) {
    return step.power ? step.what + fmt::format(" (probability of success: {})", percent(*step.power))
                      : step.what;
}

std::vector<NuisanceFit> suspects_of(const Diagnosis& diagnosis) {
    std::vector<NuisanceFit> suspects;
    if (!diagnosis.causes.empty()) {
        const auto& leader = diagnosis.causes.front();
        for (const auto& fit : diagnosis.nuisances)
            if (fit.name == leader.effect)
                suspects.push_back(
                    {fit.name, leader.amplitude, leader.amplitude_error, fit.prior, fit.unit, true});
    }
    if (!suspects.empty()) return suspects;
    for (const auto& fit : diagnosis.nuisances)
        if (fit.at_bound) suspects.push_back(fit);
    std::ranges::stable_sort(suspects,
                             [](const NuisanceFit& a, const NuisanceFit& b) { return pull(a) > pull(b); });
    return suspects;
}

std::string suspect_words(const NuisanceFit& suspect) {
    auto text = words_of(suspect.name) + ": " +
                directed_amount(suspect.name, suspect.value, suspect.error, suspect.unit);
    if (suspect.prior > 0) text += fmt::format(" ({:.1f} times its stated error)", pull(suspect));
    return text;
}

std::string sigma_words(const NuisanceFit& fit) {
    return fmt::format("{}{:.2g} sigma", fit.at_bound ? "at least " : "", pull(fit));
}

std::string check_words(const Diagnosis& diagnosis) {
    std::vector<std::string> words;
    for (const auto& fit : diagnosis.check_first)
        words.push_back(fmt::format("{} must be {} to fit ({})", words_of(fit.name),
                                    directed_amount(fit.name, fit.value, fit.error, fit.unit),
                                    sigma_words(fit)));
    if (words.empty()) return "";
    return fmt::format("check what is stated: {}; all that follows assumes {}", listed(words),
                       words.size() == 1 ? "this shift" : "these shifts");
}

namespace {

/// "adhesion and friction have no value in 4 of 8 bins (50 %)", with all that lack as many.
std::vector<std::string> lacking_words(const std::vector<MissingBins>& missing) {
    std::vector<std::string> words;
    for (std::size_t i = 0; i < missing.size(); ++i) {
        const auto alike = [&](const MissingBins& other) {
            return other.count == missing[i].count && other.all == missing[i].all;
        };
        if (std::any_of(missing.begin(), missing.begin() + static_cast<std::ptrdiff_t>(i), alike)) continue;
        std::vector<std::string> names;
        for (const auto& other : missing)
            if (alike(other))
                names.push_back(other.of.empty() ? "some runs of the scene as it stands"
                                                 : words_of(other.of));
        const bool several = names.size() > 1 || missing[i].of.empty();
        words.push_back(fmt::format("{} {} no value in {} of {} bins ({})", listed(names),
                                    several ? "have" : "has", missing[i].count, missing[i].all,
                                    percent(missing[i].share())));
    }
    return words;
}

}  // namespace

std::string missing_words(const std::vector<MissingBins>& missing) {
    std::vector<MissingBins> own, of_all;
    std::ranges::copy_if(missing, std::back_inserter(own), [](const auto& m) { return !m.for_all; });
    std::ranges::copy_if(missing, std::back_inserter(of_all), [](const auto& m) { return m.for_all; });
    std::string text;
    if (!own.empty()) text = listed(lacking_words(own)) + ", whose gap counts as not explained by it";
    if (!of_all.empty())
        text += (text.empty() ? "" : "; ") + listed(lacking_words(of_all)) + ", which are not compared";
    return text;
}

std::vector<std::string> words_of_all(const std::vector<std::string>& names) {
    std::vector<std::string> words;
    for (const auto& name : names) words.push_back(words_of(name));
    return words;
}

bool no_effect_can_be_named(const Diagnosis& diagnosis) {
    return diagnosis.explanation && diagnosis.explanation->needed > 1;
}

std::string reduction_words(const Diagnosis& diagnosis) {
    if (!diagnosis.explanation) return "takes away the gap";
    const double reduction = diagnosis.explanation->reduction;
    return reduction < 0 ? "makes the gap " + percent(-reduction) + " larger"
                         : "takes away " + percent(reduction) + " of the gap";
}

}  // namespace mcdem::report
