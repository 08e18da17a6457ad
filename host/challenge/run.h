// Every case of a blind challenge diagnosed, from its experiment alone.
#pragma once
#include <memory>

#include "ensemble/diagnose_experiment.h"
#include "ensemble/parts/parted_work.h"

namespace mcdem::inline challenge {

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
};

/// Throws InputError, also where a run lies in the folder, others are at work there, or the answers there
/// were begun with other options; RunError or Interrupted.
void run_challenge(Device& device, const Scene& scene, const ChallengeRunOptions& options);

/// The same in parts: every case is one, and before them so is every batch of the library's simulations,
/// where the library is not there yet. `scene` and `options` must live as long.
std::unique_ptr<PartedWork> challenge_parts(const Scene& scene, const ChallengeRunOptions& options);

}  // namespace mcdem::challenge
