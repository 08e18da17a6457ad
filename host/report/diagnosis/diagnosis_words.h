// Readable names of effects, quantities and probabilities of a diagnosis.
#pragma once
#include <string>
#include <vector>

#include "diagnose/decide/diagnosis.h"

namespace mcdem::inline report {

/// Readable name of an effect, nuisance or observable; unknown names with blanks instead of underscores.
std::string words_of(const std::string& name);

/// "a, b and c"; if there are more than `most`, the first ones "and N more".
std::string listed(const std::vector<std::string>& parts, std::size_t most = 100);

/// "0.421 mJ/m²": three digits, in a convenient unit. "–" if it is not finite.
std::string amount(double value, const std::string& unit);

/// "0.42 ± 0.05 mJ/m²": with as many decimals as the first two digits of the error; `sign`: with a plus sign
/// for positive values. "–" if the error is infinite.
enum class Sign { minus_only, always };
std::string amount(double value, double error, const std::string& unit, Sign sign = Sign::minus_only);

/// "81 %"; "< 1 %" for nonzero values that round to zero.
std::string percent(double fraction);

/// "p = 0.004", at most two digits.
std::string p_words(double p);

/// "18 to 24 mm", "18 mm" if both ends are equal, empty if both are zero.
std::string displacement_words(const std::array<double, 2>& displacement);

/// "loading", "unloading", or "both phases" for an empty text.
std::string phase_words(const std::string& phase);

/// The entry as a phrase: "top force while loading, at a displacement of 18 to 24 mm: 12 % higher than
/// simulated (6.1 sigma, 0.4 after recalibration)".
std::string where_words(const WhereEntry& entry);

/// The amplitude, in words with its direction if the sign means one: "0.42 ± 0.05 mJ/m²", "5.0 ± 0.4 % lower
/// than stated".
std::string directed_amount(const std::string& name, double value, double error, const std::string& unit);

/// "adhesion (0.42 ± 0.05 mJ/m²)".
std::string cause_words(const Cause& cause);

/// The effects that the explanation adds: one, or both of a pair; of a group only the leading one.
std::vector<Cause> added_causes(const Diagnosis& diagnosis);
/// Their names: "adhesion", "adhesion and friction".
std::string added_words(const Diagnosis& diagnosis);

/// "18 effects were tested".
std::string library_words(const Diagnosis& diagnosis);

/// "3 % of the gap remains unexplained (p = 0.0004)".
std::string remainder_words(const Explanation& explanation);

/// "plate.speed = 0.025 m/s instead of 0.1".
std::string refinement_words(const Refinement& refinement);

/// The step, with the predicted probability that it decides.
std::string next_words(const NextStep& step);

/// The leading cause, if it is a parameter; otherwise the parameters at their bounds, largest relative shift
/// first.
std::vector<NuisanceFit> suspects_of(const Diagnosis& diagnosis);

/// "modulus: 2.30 ± 0.20 kPa higher than stated (4.6 times its stated error)".
std::string suspect_words(const NuisanceFit& suspect);

/// "16 sigma", of its uncertainty; "at least 12 sigma" at the end of the range that is tried.
std::string sigma_words(const NuisanceFit& fit);

/// "check what is stated: modulus of the grains must be 125 ± 5 % higher than stated to fit (16 sigma); all
/// that follows assumes this shift"; empty if there is nothing to check.
std::string check_words(const Diagnosis& diagnosis);

/// "adhesion has no value in 4 of 8 bins (50 %), ..": what lacks bins; empty if nothing does.
std::string missing_words(const std::vector<MissingBins>& missing);

std::vector<std::string> words_of_all(const std::vector<std::string>& names);

/// Whether the data are so few that no reduction would suffice: random effects take away nearly all of the
/// gap.
bool no_effect_can_be_named(const Diagnosis& diagnosis);

/// "takes away 97 % of the gap", "makes the gap 20 % larger": the reduction on which the verdict depends.
std::string reduction_words(const Diagnosis& diagnosis);

}  // namespace mcdem::report
