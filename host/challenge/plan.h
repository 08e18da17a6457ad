// What the realities of a challenge are: drawn from one seed.
#pragma once
#include <span>

#include "challenge/case.h"
#include "diagnose/infer/effects.h"

namespace mcdem::inline challenge {

/// How many cases of each kind.
struct ChallengeSize {
    int none = 60;
    int per_effect = 8;
    int pairs = 20;
    int unknown =
        40;  ///< one in four with its effect struck from the library, the others by turns outside_effects()
    int outside_prior = 20;  ///< modulus and strain_offset by turns
    int packings = 24;       ///< an even number
};

/// The effects that a challenge tries where nothing else is said: of contacts, grains, plate and measurement.
std::span<const std::string_view> challenged_effects();

/// Amplitudes are log-uniform between a tenth of the smaller and 1.5 times the larger of the library's paired
/// runs, and plausible; nuisances come from their priors. Every kind is dealt evenly to both halves, and the
/// order of cases and packings tells nothing. Throws InputError where size or effects do not suit. `scene`:
/// SHA-256 of its text.
Challenge draw_challenge(const ChallengeSize& size, const std::vector<std::string>& effects,
                         const Model& model, std::span<const Nuisance> nuisances, const std::string& scene,
                         std::uint64_t seed);

}  // namespace mcdem::challenge
