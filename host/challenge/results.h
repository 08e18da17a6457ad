// The results of `mcdem challenge run`: evidence and findings of the diagnoses, stored so that limits and
// ablations can be tried without new simulations, and what is scored.
#pragma once
#include <filesystem>
#include <optional>

#include "challenge/files.h"
#include "diagnose/decide/decision.h"
#include "diagnose/infer/evidence.h"
#include "diagnose/infer/library.h"

namespace mcdem::inline challenge {

/// Predicted gap reduction on held-out data, and that of real runs.
struct PredictedReduction {
    double fraction = 0;
    std::array<double, 2> interval{0, 0};
    double confirmed = 0;
};

struct CaseResult {
    std::string problem;  ///< reason why it was not diagnosed; empty if it was
    Findings findings;
    std::map<std::string, double> detection_limits;   ///< smallest detectable amplitude by effect
    std::optional<PredictedReduction> gap_reduction;  ///< if there were confirming runs
};

struct ChallengeResults {
    Library library;
    std::vector<CaseResult> cases;  ///< in the order of the challenge
};

/// Throws InputError if the folder lacks a case or contains something else.
ChallengeResults read_challenge_results(const std::filesystem::path& folder, const OpenChallenge& challenge);

/// File with the evidence of a case.
std::filesystem::path evidence_file(const std::filesystem::path& folder, const OpenCase& open_case);

/// JSON of everything except the library, which all cases of a challenge share.
std::string evidence_text(const Evidence& evidence);
/// Throws InputError if the file is not evidence, or does not match the cells of this library.
Evidence read_evidence(const std::filesystem::path& file, const Library& library);

/// JSON.
std::string findings_text(const Findings& findings);
/// Throws InputError if the file does not contain findings.
Findings read_findings(const std::filesystem::path& file);

}  // namespace mcdem::challenge
