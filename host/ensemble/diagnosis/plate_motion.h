// The motion that an experiment states of its plate, where the scene's plate moves otherwise: grains that
// rearrange take their own time, and friction unloads while the plate stands.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "diagnose/decide/diagnosis.h"
#include "experiment/experiment.h"
#include "scene/scene.h"

namespace mcdem::inline ensemble {

struct PlateMotion {
    double speed;      ///< [m/s]; constant if the plate does not pause
    double pause = 0;  ///< at each scan [s]
    double hold = 0;   ///< at the lowest position [s]
};

/// The motion of the experiment's plate. Nothing if the scene already moves so or follows a programme, if the
/// experiment does not state its speed, or if the experiment's plate is slower than the scene's by more than
/// a factor of `max_slowdown`. Standing times are no longer than the scene's grains have to come to rest.
std::optional<PlateMotion> neglected_motion(const Replica& replica, const Experiment& experiment,
                                            double max_slowdown);
/// The changes of the scene, as keys and values.
std::vector<Refinement> changes(const Replica& replica, const PlateMotion& motion);
void apply(Replica& replica, const PlateMotion& motion);
/// The settings to make, as advice.
NextStep simulate_motion(const Replica& replica, const PlateMotion& motion);

}  // namespace mcdem::ensemble
