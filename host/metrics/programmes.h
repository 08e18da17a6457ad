// Runs of a programme: evaluated scan by scan instead of by strokes and levels.
#pragma once
#include "metrics/estimate.h"
#include "metrics/replicas.h"

namespace mcdem::inline metrics {

/// Whether the recording followed a [[programme]].
bool follows_programme(const Recording& recording);

/// Whether any of the recordings did.
bool follows_programme(const Replicas& replicas);

/// The settings that follow a programme, or those that do not.
std::vector<Setting> with_programme(const std::vector<Setting>& settings, bool programme);

/// Whether the replicas are cells, which have stresses and strains instead of forces and displacements.
bool are_cells(const Replicas& replicas);

/// Whether a stage of the programme is a hold.
bool has_hold(const Replicas& replicas);

/// Averages of the same scan over all replicas that have it.
struct MeanScan {
    int frame = 0;
    int cycle = 0;
    Phase phase = Phase::load;
    Estimate time, displacement, top_force, coordination;  ///< [s], [m], [N], 1
    Estimate packing_fraction;
    Estimate p, q;                         ///< metrics/stress_strain.h [Pa]
    std::array<Estimate, 6> strain;        ///< for cells, like the next two
    Estimate volume_strain, shear_strain;  ///< metrics/stress_strain.h
    double max_overlap = not_available;    ///< maximum over all replicas
};

std::vector<MeanScan> mean_scans(const Replicas& replicas);

}  // namespace mcdem::metrics
