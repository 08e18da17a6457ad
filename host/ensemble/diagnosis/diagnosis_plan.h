// What a diagnosis simulates and compares: the packings of an experiment, or other packings of the same kind.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "core/stop.h"
#include "ensemble/diagnosis/library_trials.h"

namespace mcdem::inline ensemble {

struct PlanOptions {
    std::vector<std::string> candidates;  ///< empty: all
    int replicates = 32;                  ///< of the baseline, on every packing
    int pairs = 8;                        ///< for every effect; at most `replicates`
    std::uint64_t seed = 1;
    bool with_recordings = false;  ///< for the metrics of the paper
    std::string program;
    /// Receives messages about what is compared otherwise than a user might expect.
    std::function<void(const std::string&)> on_note = [](const std::string&) {};
};

struct DiagnosisPlan {
    std::vector<Experiment> experiments;  ///< with the cycles that are compared
    LibraryPlan library;
    TrialSettings common;
    CandidateChoice choice;
    bool with_recordings = false;  ///< of the first trials
};

/// Simulations of the experiment's own packings. Throws InputError if an experiment has too few data, or the
/// packings of one experiment are not measured in the same way.
DiagnosisPlan plan_of(const Scene& scene, const std::vector<Experiment>& measured,
                      const PlanOptions& options);

/// Simulations of `packings` others of the same kind, for a library that several experiments share.
DiagnosisPlan plan_of_others(const Scene& scene, const Experiment& measured, int packings,
                             const PlanOptions& options, const StopWanted& stop_wanted);

/// The experiment without cycles that the scene does not have (protocol.cycles, at least one that is not
/// discarded): grains move within a cycle, so that later ones differ. A programme is compared as a whole.
Experiment compared_cycles(const Scene& scene, Experiment experiment);

/// The scene's first replica with the experiment's box, plate and scans. Throws InputError if the experiment
/// does not contain enough data to simulate it.
Model model_of(const Scene& scene, const Experiment& experiment);

/// Simulations have the materials of the scene: "grains.youngs_modulus = 30000 (scene: 23300)" for each that
/// is stated and that the scene does not have. With several species, which have their own, none.
std::vector<std::string> other_materials(const Replica& replica, const std::map<std::string, double>& stated);

/// Positions of the experiment's grains at its first frame.
Packing start_packing(const Experiment& experiment);

}  // namespace mcdem::ensemble
