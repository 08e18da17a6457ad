// The simulations of a diagnosis' library: which they are, and in parts for many processes.
#pragma once
#include <memory>

#include "ensemble/diagnose_experiment.h"
#include "ensemble/parts/parted_work.h"

namespace mcdem::inline ensemble {

/// Trials of a baseline whose recordings are kept whole: the paper's metrics are taken from them.
constexpr std::size_t trials_recorded = 4;
void keep_recordings(std::vector<Trial>& trials);

/// The work of a diagnosis before it begins: what is simulated, and how it is looked at. Throws InputError
/// where an experiment does not say enough, or the packings of one are not measured alike.
struct DiagnosisPlan {
    LibraryPlan library;
    Question question;
    CandidateChoice choice;
};
DiagnosisPlan plan_of(const Scene& scene, const std::vector<Experiment>& experiments,
                      const DiagnoseOptions& options);

/// Nothing is left where the library's file is there; with all parts there, diagnose_experiment makes the
/// library without simulating. Holds the folder's lock with others. The arguments must live as long. Throws
/// InputError where the experiment cannot be diagnosed.
std::unique_ptr<PartedWork> library_parts(const Scene& scene, const std::vector<Experiment>& experiments,
                                          const DiagnoseOptions& options);

}  // namespace mcdem::ensemble
