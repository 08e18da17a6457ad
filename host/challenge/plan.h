// Draws the cases of a challenge from one seed.
#pragma once
#include <span>

#include "challenge/case.h"
#include "diagnose/infer/effects.h"

namespace mcdem::inline challenge {

/// Number of cases of each kind.
struct ChallengeSize {
    int none = 60;
    int per_effect = 8;
    int pairs = 20;
    int unknown = 40;  ///< one in four with its effect removed from the library, the others with each of
                       ///< outside_effects() in turn
    int outside_prior = 20;  ///< modulus and strain_offset in turn
    int packings = 24;       ///< an even number
};

/// Default effects of a challenge: of contacts, grains, plate and measurement.
std::span<const std::string_view> challenged_effects();

/// Amplitudes are log-uniform between a tenth of the smaller and 1.5 times the larger one of the library's
/// paired runs, and plausible. Nuisances are drawn from their priors. Every kind is distributed evenly over
/// both halves, and the order of cases and packings is random. Throws InputError if size or effects are
/// unsuitable. `scene`: SHA-256 of its text.
Challenge draw_challenge(const ChallengeSize& size, const std::vector<std::string>& effects,
                         const Model& model, std::span<const Nuisance> nuisances, const std::string& scene,
                         std::uint64_t seed);

}  // namespace mcdem::challenge
