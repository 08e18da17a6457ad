// The score of a challenge: what was answered, against what was sealed.
#pragma once
#include <filesystem>
#include <functional>

#include "challenge/limits.h"
#include "challenge/results.h"

namespace mcdem::inline challenge {

/// A way of answering, its limits set on the first half of the packings.
struct ArmScore {
    std::string name, meaning;
    bool has_limits = true;  ///< simpler methods have none
    Limits limits;
    Merits first, second;  ///< on the half that limits were set on, and on the other
};

/// Predicted against realised reduction of the gap, over all cases with confirming runs: no limit enters
/// them.
struct GapReductionScore {
    int cases = 0;
    double median_error = 0;  ///< median |predicted - confirmed|
    Share covered;            ///< the 90 % interval holds what was confirmed
};

struct ChallengeScore {
    int cases = 0;
    std::vector<std::string> not_diagnosed;  ///< folder and reason
    std::vector<ArmScore> arms;              ///< the whole method first
    GapReductionScore gap_reduction;
    std::vector<ScoredCase> scored;  ///< second half, by the whole method
};

/// `truth` must be the challenge's, sorted like it. `on_progress`: part of the ablations that is done.
ChallengeScore score_challenge(const Challenge& truth, const OpenChallenge& open,
                               const std::filesystem::path& folder,
                               const std::function<void(double)>& on_progress);

}  // namespace mcdem::challenge
