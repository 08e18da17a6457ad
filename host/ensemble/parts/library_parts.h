// The simulations of a diagnosis's library, as parts for several processes.
#pragma once
#include <memory>

#include "ensemble/diagnosis/diagnose_experiment.h"
#include "ensemble/parts/parted_work.h"

namespace mcdem::inline ensemble {

/// Number of baseline trials with complete recordings, for the metrics of the paper.
constexpr std::size_t trials_recorded = 4;
void keep_recordings(std::vector<Trial>& trials);

/// The simulations of a diagnosis and their observation. Throws InputError if an experiment has too few data,
/// or the packings of one experiment are not measured in the same way.
struct DiagnosisPlan {
    std::vector<Experiment> experiments;  ///< with the cycles that are compared
    LibraryPlan library;
    TrialSettings common;
    CandidateChoice choice;
};
DiagnosisPlan plan_of(const Scene& scene, const std::vector<Experiment>& measured,
                      const DiagnoseOptions& options);

/// Nothing is missing if the library's file exists. When all parts exist, diagnose_experiment builds the
/// library without simulating. Holds a shared lock on the folder. The arguments must outlive the result.
/// Throws InputError if the experiment cannot be diagnosed.
std::unique_ptr<PartedWork> library_parts(const Scene& scene, const std::vector<Experiment>& experiments,
                                          const DiagnoseOptions& options);

}  // namespace mcdem::ensemble
