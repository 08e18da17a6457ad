// How effects, quantities and probabilities of a diagnosis are called where people read them.
#pragma once
#include <string>
#include <vector>

#include "diagnose/decide/diagnosis.h"

namespace mcdem::inline report {

/// An effect, nuisance or observable in words; one that is not known by name with blanks for its underscores.
std::string words_of(const std::string& name);

/// "a, b and c"; of more than `most` the first ones "and N more".
std::string listed(const std::vector<std::string>& parts, std::size_t most = 100);

/// "0.421 mJ/m²": three digits, in the unit that people use for it. "–" where it is not finite.
std::string amount(double value, const std::string& unit);

/// "0.42 ± 0.05 mJ/m²": as many decimals as the first two digits of the error; `sign`: with a plus too.
/// "–" where the error is infinite.
enum class Sign { minus_only, always };
std::string amount(double value, double error, const std::string& unit, Sign sign = Sign::minus_only);

/// "81 %"; "< 1 %" for what would round to nothing but is not.
std::string percent(double fraction);

/// "p = 0.004", at most two digits.
std::string p_words(double p);

/// "18 to 24 mm", "18 mm" where both ends are one, empty where both are zero.
std::string displacement_words(const std::array<double, 2>& displacement);

/// "loading", "unloading", "both phases" where it is empty.
std::string phase_words(const std::string& phase);

/// The entry as a phrase: "top force while loading, 18 to 24 mm: 12 % higher than simulated (6.1 sigma,
/// 0.4 after recalibration)".
std::string where_words(const WhereEntry& entry);

/// The amplitude with its direction where its sign means one: "0.42 ± 0.05 mJ/m²", "5.0 ± 0.4 % lower than
/// stated".
std::string directed_amount(const std::string& name, double value, double error, const std::string& unit);

/// "adhesion (0.42 ± 0.05 mJ/m²)".
std::string cause_words(const Cause& cause);

/// The paper's metrics in its order, then others: name, before and after.
std::vector<std::pair<std::string, std::array<double, 2>>> metrics_in_order(
    const GapReduction& gap_reduction);

/// The effects that were tried: "the 18 known effects".
std::string library_words(const Diagnosis& diagnosis);

/// "plate.speed = 0.025 m/s instead of 0.1".
std::string refinement_words(const Refinement& refinement);

/// The step, and how often it is predicted to decide.
std::string next_words(const NextStep& step);

/// The leading cause, where that is a parameter and no effect; else the parameters at their bounds, the one
/// pulled furthest first.
std::vector<NuisanceFit> suspects_of(const Diagnosis& diagnosis);

/// "modulus: 2.30 ± 0.20 kPa higher than stated (4.6 times its stated error)".
std::string suspect_words(const NuisanceFit& suspect);

}  // namespace mcdem::report
