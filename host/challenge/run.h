// Diagnoses every case of a blind challenge from its experiment only.
#pragma once
#include <memory>

#include "core/stop.h"
#include "ensemble/diagnosis/diagnose_experiment.h"
#include "ensemble/parts/parted_work.h"

namespace mcdem::inline challenge {

/// Size of the challenge's signature library, if it does not exist yet.
struct ChallengeLibrary {
    std::filesystem::path file;
    int packings = 16;                    ///< generated, different from those of the cases
    int replicates = 4;                   ///< per packing
    int pairs = 1;                        ///< number of replicates that are repeated with every effect
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
    /// Writes a diagnosis to out/<case>.json; a case with this file is not diagnosed again.
    std::function<void(const std::filesystem::path& file, const Diagnosis&)> keep;
    std::function<void(double fraction)> on_progress = [](double) {};
    /// Called if a case cannot be diagnosed; its file contains the reason, and it counts as a miss.
    std::function<void(const std::string& message)> on_problem = [](const std::string&) {};
    StopWanted stop_wanted = never_stop;
};

/// Throws InputError, also if the folder contains a run, is in use by other processes, or contains answers
/// with other options; RunError or Interrupted.
void run_challenge(Device& device, const Scene& scene, const ChallengeRunOptions& options);

/// The same in parts: one per case, preceded by batches of the library's simulations if the library does not
/// exist yet. `scene` and `options` must outlive the result.
std::unique_ptr<PartedWork> challenge_parts(const Scene& scene, const ChallengeRunOptions& options);

}  // namespace mcdem::challenge
