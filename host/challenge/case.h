// One simulated experiment of the blind challenge: its differences from the scene.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/names.h"

namespace mcdem::inline challenge {

enum class CaseKind {
    none,           ///< only what every case has: hidden nuisances, other numerics, noise
    effect,         ///< one effect of the library
    pair,           ///< two of them
    unknown,        ///< an effect that the library of its diagnosis does not have
    outside_prior,  ///< no effect, but a nuisance far outside its prior
};

}  // namespace mcdem::challenge

template <>
inline constexpr std::array<std::string_view, 5> mcdem::name_list<mcdem::CaseKind>{
    "none", "effect", "pair", "unknown", "outside_prior"};

namespace mcdem::inline challenge {

/// An effect or a nuisance with its amplitude.
struct Hidden {
    std::string name;
    double amplitude = 0;
    bool operator==(const Hidden&) const = default;
};

struct ChallengeCase {
    std::string folder;  ///< of its experiment, in the folder of the challenge
    CaseKind kind = CaseKind::none;
    std::vector<Hidden>
        effects;  ///< of the library; for unknown ones from outside_effects() or removed from the library
    std::vector<Hidden> nuisances;    ///< shifts of all nuisances
    std::vector<std::string> struck;  ///< effects that its diagnosis may not name
    int packing = 0;                  ///< number of its packing
    std::uint64_t seed = 0;           ///< for its jitter, random properties of its effects, and its noise
    bool operator==(const ChallengeCase&) const = default;
};

/// The hidden truth.
struct Challenge {
    std::uint64_t seed = 0;
    std::string scene_sha256;                  ///< SHA-256 of the scene's text
    std::vector<std::uint64_t> packing_seeds;  ///< by packing
    std::vector<ChallengeCase> cases;          ///< in the order of their folders
    bool operator==(const Challenge&) const = default;
};

/// Limits are set on the cases of one half of the packings and scored on the other.
inline bool in_first_half(int packing) { return packing % 2 == 0; }

}  // namespace mcdem::challenge
