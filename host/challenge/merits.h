// Figures of merit of a challenge, from the verdicts and the named effects.
#pragma once
#include <map>
#include <span>

#include "challenge/case.h"
#include "diagnose/decide/decision.h"

namespace mcdem::inline challenge {

/// The scored part of a diagnosis: the verdict and the leading effects.
struct Answer {
    Verdict verdict = Verdict::no_gap;
    std::vector<std::string>
        group;  ///< effects that cannot be distinguished, or both of a pair; the leading one first
    double confidence = 0;  ///< of the leading effect
    bool detected() const { return verdict != Verdict::no_gap; }
    /// Whether the effects are named as the cause.
    bool names() const { return verdict == Verdict::effect || verdict == Verdict::group; }
    /// Whether a probability is stated for a leading effect, named or not.
    bool leads() const { return !group.empty() && (names() || verdict == Verdict::unknown_effect); }
};

Answer answer_of(const Findings& findings, const Limits& limits);

/// Number of cases with a property, among all that could have it.
struct Share {
    int hits = 0, of = 0;
    void add(bool hit) { hits += hit, ++of; }
    double value() const { return of > 0 ? static_cast<double>(hits) / of : 0; }
};

/// A case, its answer, and the detection limit of its diagnosis.
struct ScoredCase {
    const ChallengeCase* truth = nullptr;
    Answer answer;
    double over_limit = 0;  ///< amplitude of the only effect over its predicted detection limit; 0: no
                            ///< effect, two, or no limit
};

struct Merits {
    Share false_alarms;     ///< without an effect: a gap is claimed
    Share detected;         ///< one effect: a gap is detected
    Share detected_clear;   ///< one effect of at least `clear` times the limit: detected
    Share led_by_truth;     ///< of the detected clear ones: the effect named first is the true one
    Share truth_in_group;   ///< of the detected clear ones: the true effect is among the named ones
    Share named;            ///< one effect, any amplitude: the effect named first is the true one
    double group_size = 0;  ///< of the detected clear ones: mean number of named effects, if any
    double sharpness = 0;  ///< one clear effect: mean of 1/(number of named effects) if the true one is among
                           ///< them, otherwise 0
    Share named_unknown;   ///< an effect outside the library: effects of the library are named
    Share named_outside_prior;  ///< a nuisance outside its prior: effects are named
    Share suspected;            ///< a nuisance outside its prior: the calibration is suspected
    Share pair_led;             ///< two effects: the one named first is one of them
    Share pair_found;           ///< two effects: both are named, and no other
    double brier = 0;           ///< mean square of (confidence - right) for all cases with a leading effect
    Share right_leaders;        ///< all cases with a leading effect, named or not: it is a true one
    std::map<std::string, Share> detected_by_effect, named_by_effect;  ///< one effect
    std::map<std::string, Share> named_by_unknown;                     ///< outside the library, by effect
};

/// Amplitudes of at least this many detection limits are clear.
inline constexpr double clear = 1.5;

Merits merits_of(std::span<const ScoredCase> cases);

/// Whether the leading effect, named or not, is one of the true ones.
bool leader_is_true(const ScoredCase& scored);

/// Whether the effect named first is one of the true ones.
bool leads_rightly(const ScoredCase& scored);

/// For an unknown effect: the name of the outside effect, or "struck" if it was removed from the library.
std::string unknown_name(const ChallengeCase& truth);

}  // namespace mcdem::challenge
