// The simulations of a library: baseline replicates and, from the same initial packings, every effect and
// nuisance at two amplitudes.
#pragma once
#include "ensemble/diagnosis/observe_trials.h"

namespace mcdem::inline ensemble {

/// A packing and its model.
struct LibraryPacking {
    Model model;
    Packing packing;
};

struct LibraryPlan {
    std::vector<LibraryPacking> packings;  ///< one or several
    int replicates = 32;                   ///< baseline runs of each packing, jittered
    int pairs = 8;                         ///< number of them that are repeated with every effect
    double jitter = 0;           ///< standard deviation of the noise on every initial coordinate [m]
    double diameter_jitter = 0;  ///< standard deviation of the noise on every diameter [m]
    std::uint64_t seed = 1;
    std::vector<std::string> candidates;  ///< effects
    std::vector<Nuisance> nuisances;
};

/// The trials of a baseline, one packing after the other. Replicate r of packing p has the same seed in
/// every library and diagnosis.
std::vector<Trial> baseline_trials(const LibraryPlan& plan);

/// The same with half the error of positions, in the measurement and in the initial positions.
std::vector<Trial> finer_baseline_trials(LibraryPlan plan);

/// All trials of a library: those of the baseline, then some of them with every effect and nuisance.
std::vector<Trial> library_trials(const LibraryPlan& plan);

/// Rows of the baseline trials that are repeated with every probe.
std::vector<std::size_t> paired_trials(const LibraryPlan& plan);

/// An effect or nuisance that is simulated at two amplitudes.
struct Probe {
    std::string name;
    double amplitudes[2];
    void (*apply)(Model&, double);
};
/// The candidates, then the nuisances. Amplitudes use the scale of the first packing.
std::vector<Probe> probes_of(const LibraryPlan& plan);

/// Name of the effect or nuisance of a trial of the library; empty for the baseline.
std::string probe_of_trial(const LibraryPlan& plan, std::size_t trial);

/// Candidates in `wanted` (empty: all) that this model can have; the others with reasons.
struct CandidateChoice {
    std::vector<std::string> chosen;
    std::vector<std::string> hindered;  ///< "friction_history: the scene has no friction"
};
/// Throws InputError for names that are not effects.
CandidateChoice choose_candidates(const Model& model, const std::vector<std::string>& wanted);

}  // namespace mcdem::ensemble
