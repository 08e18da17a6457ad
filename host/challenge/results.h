// What `mcdem challenge run` left behind, as far as it is scored.
#pragma once
#include <filesystem>
#include <optional>

#include "challenge/files.h"
#include "diagnose/decide/decision.h"
#include "diagnose/infer/library.h"

namespace mcdem::inline challenge {

/// What was said about the gap on held-out data, and what real runs said of it.
struct PredictedReduction {
    double fraction = 0;
    std::array<double, 2> interval{0, 0};
    double confirmed = 0;
};

struct CaseResult {
    std::string problem;  ///< why it was not diagnosed, empty where it was
    Findings findings;
    std::map<std::string, double> detection_limits;   ///< smallest amplitude by effect
    std::optional<PredictedReduction> gap_reduction;  ///< where there were confirming runs
};

struct ChallengeResults {
    Library library;
    std::vector<CaseResult> cases;  ///< in the order of the challenge
};

/// Throws InputError where the folder lacks a case or holds something else.
ChallengeResults read_challenge_results(const std::filesystem::path& folder, const OpenChallenge& challenge);

/// Where run keeps the evidence of a case.
std::filesystem::path evidence_file(const std::filesystem::path& folder, const OpenCase& open_case);

}  // namespace mcdem::challenge
