// Every case of a blind challenge diagnosed, from its experiment alone.
#pragma once
#include "ensemble/diagnose_experiment.h"

namespace mcdem {

/// How large the challenge's signature library is, where it is not there yet.
struct ChallengeLibrary {
    std::filesystem::path file;
    int packings = 16;                    ///< generated, other ones than those of the cases
    int replicates = 4;                   ///< a packing
    int pairs = 1;                        ///< of them, those repeated with every effect
    std::vector<std::string> candidates;  ///< empty: all
};

struct ChallengeRunOptions {
    std::filesystem::path challenge;  ///< its folder
    std::filesystem::path out;        ///< case_0001.json .., library.json, evidence/, findings/, simulations/
    ChallengeLibrary library;
    int replicates = 8;
    int confirmations = 4;
    std::uint64_t seed = 1;
    std::string program;
    /// Keeps a diagnosis as out/<case>.json; a case that has this file is not diagnosed again.
    std::function<void(const std::filesystem::path& file, const Diagnosis&)> keep;
    std::function<void(double fraction)> on_progress = [](double) {};
    /// A case could not be diagnosed; its file says why, and it counts as a miss.
    std::function<void(const std::string& message)> on_problem = [](const std::string&) {};
    std::function<bool()> stop_wanted = [] { return false; };
    bool share = false;  ///< with other programs that work on the same folder
};

/// Throws InputError, also where a run lies in the folder or others at work there do not go with this;
/// RunError or Interrupted.
void run_challenge(Device& device, const Scene& scene, const ChallengeRunOptions& options);

/// For those who only start others: throws InputError where run_challenge would because of what lies in the
/// folder or is written there.
void expect_sharable_challenge(const std::filesystem::path& out);

/// Throws InputError where the answers to a challenge lie, or are made: no folder for a run.
void expect_no_challenge(const std::filesystem::path& folder);

/// The part of the cases that are diagnosed, with those under way; 1 when all are.
double cases_done(const ChallengeRunOptions& options);

}  // namespace mcdem
