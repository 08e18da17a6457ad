// Runs of a programme: scans one after the other, in place of strokes sorted into levels.
#pragma once
#include "metrics/estimate.h"
#include "metrics/replicas.h"

namespace mcdem::inline metrics {

/// Whether the recording was taken through a [[programme]].
bool follows_programme(const Recording& recording);

/// Whether any of the recordings was.
bool follows_programme(const Replicas& replicas);

/// The settings that do, or those that do not.
std::vector<Setting> with_programme(const std::vector<Setting>& settings, bool programme);

/// Whether the setting is one of cells, which have stresses and strains in place of forces and displacements.
bool are_cells(const Replicas& replicas);

/// Whether a stage of the programme holds something for a time.
bool has_hold(const Replicas& replicas);

/// The same scan of all replicas that have it.
struct MeanScan {
    int frame = 0;
    int cycle = 0;
    Phase phase = Phase::load;
    Estimate time, displacement, top_force, coordination;  ///< [s], [m], [N], 1
    Estimate packing_fraction;
    Estimate p, q;                         ///< metrics/stress_strain.h [Pa]
    std::array<Estimate, 6> strain;        ///< of cells, as are the next two
    Estimate volume_strain, shear_strain;  ///< metrics/stress_strain.h
    double max_overlap = not_available;    ///< of all replicas
};

std::vector<MeanScan> mean_scans(const Replicas& replicas);

}  // namespace mcdem::metrics
