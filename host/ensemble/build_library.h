// Makes the signature library of a scene: baseline replicates and, from the same starts, every effect and
// nuisance at two amplitudes.
#pragma once
#include "diagnose/infer/library.h"
#include "ensemble/observe_trials.h"

namespace mcdem::inline ensemble {

/// A packing and the model of it.
struct Specimen {
    Model model;
    Packing packing;
};

struct LibraryPlan {
    std::vector<Specimen> specimens;  ///< one or several
    int replicates = 32;              ///< baseline runs of each, jittered
    int pairs = 8;                    ///< of them, those repeated with every effect
    double jitter = 0;                ///< sd of every coordinate of the start [m]
    double diameter_jitter = 0;       ///< sd of every diameter [m]
    std::uint64_t seed = 1;
    std::vector<std::string> candidates;  ///< effects
    std::vector<Nuisance> nuisances;
};

/// The trials of a baseline, one specimen after the other: replicate r of specimen p has the same seed in
/// every library and diagnosis.
std::vector<Trial> baseline_trials(const LibraryPlan& plan);

/// All trials of a library: those of the baseline, then pairs of them with every effect and nuisance.
std::vector<Trial> library_trials(const LibraryPlan& plan);

Library build_library(Device& device, const Question& question, const LibraryPlan& plan,
                      const ObservationStore& store, const TrialOptions& options);

/// Candidates of `wanted` (all where empty) that this model can have; the others with why not.
struct CandidateChoice {
    std::vector<std::string> chosen;
    std::vector<std::string> hindered;  ///< "friction_history: the scene has no friction"
};
/// Throws InputError for names that are no effects.
CandidateChoice choose_candidates(const Model& model, const std::vector<std::string>& wanted);

}  // namespace mcdem::ensemble
