// A scene held against an experiment: simulations, library, verdict.
#pragma once
#include <filesystem>
#include <optional>

#include "diagnose/decide/diagnose.h"
#include "ensemble/build_library.h"

namespace mcdem::inline ensemble {

struct DiagnoseOptions {
    std::filesystem::path folder;         ///< observations are kept here, in `simulations`
    std::vector<std::string> candidates;  ///< empty: all
    int replicates = 32;                  ///< of the baseline, on the experiment's packing
    int pairs = 8;                        ///< of every effect
    int confirmations = 8;                ///< real runs of the cause
    /// Where the simulation's own numerics explain the gap, it is refined once, by so many times at most, and
    /// diagnosed again; 1: never.
    double refine = 4;
    bool paper_metrics = true;  ///< Rtop, errf, errZ, bhat before and after
    std::uint64_t seed = 1;
    std::optional<std::filesystem::path> library;  ///< read where it is there, else made and written
    std::string program;
    Limits limits;
    std::function<void(const std::string& stage, double fraction)> on_progress = [](const std::string&,
                                                                                    double) {};
    std::function<bool()> stop_wanted = [] { return false; };
    /// Gets what is left out because its simulations failed.
    std::function<void(const std::string&)> on_note = [](const std::string&) {};
    /// Gets what the diagnosis rests on, once it is gathered: limits and ablations are tried on it without
    /// simulations.
    std::function<void(const Evidence&)> on_evidence = [](const Evidence&) {};
    /// Gets the numbers that the verdict was decided on.
    std::function<void(const Findings&)> on_findings = [](const Findings&) {};
};

/// The scene's first replica with the experiment's box, plate and scans. Throws InputError where the
/// experiment does not say enough to simulate it.
Model model_of(const Scene& scene, const Experiment& experiment);

/// Where the experiment's grains were at its first frame.
Packing start_packing(const Experiment& experiment);

/// One experiment, or several packings of one: a verdict for all of them together. Throws InputError,
/// RunError or Interrupted.
Diagnosis diagnose_experiment(Device& device, const Scene& scene, const std::vector<Experiment>& experiments,
                              const DiagnoseOptions& options);

}  // namespace mcdem::ensemble
