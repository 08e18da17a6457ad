// Pauses of an experiment's plate, in which friction unloads.
#pragma once
#include <optional>

#include "diagnose/decide/diagnosis.h"
#include "experiment/experiment.h"
#include "scene/scene.h"

namespace mcdem::inline ensemble {

/// How the plate of an experiment pauses at each scan.
struct PlatePauses {
    double time;   ///< [s]
    double speed;  ///< of the plate between pauses [m/s]
};

/// Pauses of the experiment that the scene does not simulate. Nothing if there are none, or if the
/// experiment's plate is slower than the scene's by more than a factor of `max_slowdown` or its speed is not
/// stated: the slower the plate, the less friction unloads while it stands.
std::optional<PlatePauses> neglected_pauses(const Replica& replica, const Experiment& experiment,
                                            double max_slowdown);
void apply(Replica& replica, const PlatePauses& pauses);
/// The settings to make, as advice.
NextStep simulate_pauses(const PlatePauses& pauses);

}  // namespace mcdem::ensemble
