// Score of a challenge: compares the answers with the sealed truth.
#pragma once
#include <filesystem>
#include <functional>

#include "challenge/limits.h"
#include "challenge/results.h"

namespace mcdem::inline challenge {

/// A method, with limits set on the first half of the packings.
struct ArmScore {
    std::string name, meaning;
    bool has_limits = true;  ///< false for simpler methods
    Limits limits;
    Merits first, second;  ///< on the half that was used to set limits, and on the other one
};

/// Predicted and realised gap reduction, over all cases with confirming runs. It does not depend on limits.
struct GapReductionScore {
    int cases = 0;
    double median_error = 0;  ///< median |predicted - confirmed|
    Share covered;            ///< the 90 % interval contains the realised value
};

struct ChallengeScore {
    int cases = 0;
    std::vector<std::string> not_diagnosed;  ///< folder and reason
    std::vector<ArmScore> arms;              ///< the whole method first
    GapReductionScore gap_reduction;
    std::vector<ScoredCase> scored;  ///< second half, by the whole method
};

/// `truth` must belong to the challenge and have the same order. `on_progress`: completed fraction of the
/// ablations.
ChallengeScore score_challenge(const Challenge& truth, const OpenChallenge& open,
                               const std::filesystem::path& folder,
                               const std::function<void(double)>& on_progress);

}  // namespace mcdem::challenge
