// Diagnosis of a scene and an experiment: simulations, library, verdict.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/stop.h"
#include "diagnose/decide/diagnose.h"
#include "ensemble/diagnosis/build_library.h"

namespace mcdem::inline ensemble {

struct DiagnoseOptions {
    std::filesystem::path folder;         ///< its subfolder `simulations` stores observations
    std::vector<std::string> candidates;  ///< empty: all
    int replicates = 32;                  ///< of the baseline, on the experiment's packing
    int pairs = 8;                        ///< for every effect; at most `replicates`
    int confirmations = 8;                ///< real runs of each proposal
    /// If the simulation's own numerics explain the gap, they are refined once by at most this factor, and
    /// the diagnosis is repeated; 1: never. Above 1, pauses of the experiment's plate are also simulated if
    /// there is a gap.
    double refine = 4;
    bool paper_metrics = true;  ///< Rtop, errf, errZ, bhat before and after
    std::uint64_t seed = 1;
    std::optional<std::filesystem::path> library;  ///< read if it exists, otherwise computed and written
    std::string program;
    Limits limits;
    std::function<void(const std::string& stage, double fraction)> on_progress = [](const std::string&,
                                                                                    double) {};
    StopWanted stop_wanted = never_stop;
    /// Receives messages about what is left out because its simulations failed.
    std::function<void(const std::string&)> on_note = [](const std::string&) {};
    /// Receives the evidence when it is complete, to try limits and ablations without simulations.
    std::function<void(const Evidence&)> on_evidence = [](const Evidence&) {};
    /// Receives the numbers on which the verdict is based.
    std::function<void(const Findings&)> on_findings = [](const Findings&) {};
};

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

/// Diagnoses one experiment, or several packings of one experiment with a common verdict. Throws InputError,
/// RunError or Interrupted.
Diagnosis diagnose_experiment(Device& device, const Scene& scene, const std::vector<Experiment>& experiments,
                              const DiagnoseOptions& options);

}  // namespace mcdem::ensemble
