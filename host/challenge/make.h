// A blind challenge made: realities simulated with what is hidden, measured, and written as experiments that
// tell nothing of it.
#pragma once
#include <filesystem>
#include <functional>
#include <optional>

#include "challenge/plan.h"
#include "cl/device.h"

namespace mcdem::inline challenge {

struct ChallengeOptions {
    std::filesystem::path folder;  ///< of the challenge
    std::filesystem::path truth;   ///< file of the answers
    std::optional<std::uint64_t>
        seed;  ///< nothing: that of the truth where it is there, else one that nobody knows
    ChallengeSize size;
    std::vector<std::string> effects;  ///< empty: challenged_effects()
    Measurement measurement;           ///< how well all of them are measured
    std::function<void(double fraction)> on_progress = [](double) {};
    std::function<bool()> stop_wanted = [] { return false; };
};

/// Tries whether all realities can be simulated, and weakens those that run away; writes the truth, then
/// challenge.json, then the folders that are not there yet. Returns the seal, SHA-256 of the truth. Throws
/// InputError where the scene does not suit or the folder holds another challenge, RunError where a
/// simulation fails, Interrupted when stop_wanted says so.
std::string make_challenge(Device& device, const Scene& scene, const ChallengeOptions& options);

}  // namespace mcdem::challenge
