// The motion that an experiment states of its plate, where the scene's plate moves otherwise: grains that
// rearrange take their own time, and friction unloads while the plate stands.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "experiment/experiment.h"
#include "scene/scene.h"

namespace mcdem::inline ensemble {

/// Of a key of the scene.
struct SettingChange {
    std::string key, unit;
    double from = 0, to = 0;
};

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
std::vector<SettingChange> changes(const Replica& replica, const PlateMotion& motion);
void apply(Replica& replica, const PlateMotion& motion);

}  // namespace mcdem::ensemble
