// How well answers did against the truth: the figures of merit of a challenge.
#pragma once
#include <map>
#include <span>

#include "challenge/answer.h"
#include "challenge/case.h"

namespace mcdem::inline challenge {

/// Cases that have something, of all that could have.
struct Share {
    int hits = 0, of = 0;
    void add(bool hit) { hits += hit, ++of; }
    double value() const { return of > 0 ? static_cast<double>(hits) / of : 0; }
};

/// A case, how it was answered, and what its diagnosis said it could detect.
struct ScoredCase {
    const ChallengeCase* truth = nullptr;
    Answer answer;
    double over_limit =
        0;  ///< size of the only effect over its predicted detection limit; 0: no effect, two, or no limit
};

struct Merits {
    Share false_alarms;     ///< without an effect: a gap is found
    Share detected;         ///< one effect: a gap is found
    Share detected_clear;   ///< .. at `clear` times the limit or more
    Share led_by_truth;     ///< .. of those: the effect named first is the true one
    Share truth_in_group;   ///< .. of those: the true effect is among those named
    Share named;            ///< one effect, any amplitude: the effect named first is the true one
    double group_size = 0;  ///< .. of those: mean over the ones that are named
    double sharpness =
        0;  ///< one clear effect: mean of 1/(effects named) where the true one is among them, else 0
    Share named_unknown;        ///< an effect outside the library: effects of the library are named
    Share named_outside_prior;  ///< a nuisance outside its prior: effects are named
    Share suspected;            ///< .. : the calibration is suspected
    Share pair_led;             ///< two effects: the one named first is one of them
    Share pair_found;           ///< two effects: both are named, and no other
    double brier = 0;           ///< mean square of (confidence - right), wherever effects are named
    Share right_where_named;    ///< .. : the effect named first is a true one
    std::map<std::string, Share> detected_by_effect, named_by_effect;  ///< one effect
    std::map<std::string, Share> named_by_unknown;                     ///< outside the library, by what it is
};

/// Amplitudes from this many detection limits on are clear.
inline constexpr double clear = 1.5;

Merits merits_of(std::span<const ScoredCase> cases);

/// The effect named first is one of the true ones.
bool leads_rightly(const ScoredCase& scored);

/// Of an unknown effect: the outside effect's name, or "struck".
std::string unknown_name(const ChallengeCase& truth);

}  // namespace mcdem::challenge
