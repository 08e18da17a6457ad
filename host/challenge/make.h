// Generates a blind challenge: experiments with hidden effects are simulated, measured, and written as
// experiments that do not reveal them.
#pragma once
#include <filesystem>
#include <functional>
#include <optional>

#include "challenge/plan.h"
#include "cl/device.h"
#include "core/stop.h"

namespace mcdem::inline challenge {

struct ChallengeOptions {
    std::filesystem::path folder;  ///< of the challenge
    std::filesystem::path truth;   ///< truth file
    std::optional<std::uint64_t>
        seed;  ///< default: that of an existing truth file, otherwise a random one that nobody knows
    ChallengeSize size;
    std::vector<std::string> effects;  ///< empty: challenged_effects()
    Measurement measurement;           ///< accuracy of all measurements
    std::function<void(double fraction)> on_progress = [](double) {};
    StopWanted stop_wanted = never_stop;
};

/// Tests whether all cases can be simulated, and reduces the amplitudes of those that diverge. Then
/// writes the truth, challenge.json, and missing folders, in this order. Returns the seal, the SHA-256 of the
/// truth. Throws InputError if the scene is unsuitable or the folder contains another challenge, RunError if
/// a simulation fails, Interrupted if stop_wanted returns true.
std::string make_challenge(Device& device, const Scene& scene, const ChallengeOptions& options);

}  // namespace mcdem::challenge
