// Measured compressions in the same form as simulations (host/python/mcdem/experiment reads their folders,
// README.md in this folder).
#pragma once
#include <map>
#include <optional>
#include <string>

#include "core/recording.h"

namespace mcdem::inline experiment {

/// Accuracy of the measurement; simulations are measured with the same instrument before they are compared.
struct Measurement {
    double position_error = 0;   ///< sigma of every coordinate of a centre [m]
    double diameter_error = 0;   ///< sigma [m]
    double force_error = 0;      ///< relative sigma of a contact force
    double force_threshold = 0;  ///< weaker contacts are not detected [N]
    bool operator==(const Measurement&) const = default;
};

struct Experiment {
    std::string name;
    /// Positions, contacts and top force of each scan. Z, <f> and <b> are computed from the contacts above
    /// the force threshold; unmeasured values are NaN or empty.
    Recording recording;
    std::map<std::string, double> materials;    ///< scene keys that were measured: "grains.youngs_modulus"
    std::map<std::string, double> uncertainty;  ///< one sigma of some of them, by key
    Measurement measurement;
    std::optional<double> plate_speed = {};  ///< [m/s]; empty: slow
    double plate_pause = 0;  ///< the plate stands for this time at each scan [s]; 0: it does not stop
    double plate_hold = 0;   ///< .. at the lowest position [s]
};

}  // namespace mcdem::experiment
