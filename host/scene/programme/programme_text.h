// A programme in the parameters of a recording, and the place of each scan in it.
#pragma once
#include <toml++/toml.h>

#include <vector>

#include "core/parameters.h"
#include "scene/programme/legs.h"

namespace mcdem::inline scene {

/// "programme.1.stage" and the other keys of all stages with their values.
Parameters programme_parameters(const std::vector<Stage>& programme);

/// The stages in a recording's parameters; none if it followed strokes. Throws InputError if the parameters
/// cannot come from a scene.
std::vector<Stage> programme_of(const Parameters& parameters);

/// [[programme]] tables with the values of each stage that differ from the defaults.
toml::array programme_tables(const std::vector<Stage>& programme);

/// Place of a scan in a programme. Refers to scan n + 1 of a recording, because scan 0 is the packing at
/// rest.
struct ScanPlace {
    int stage = 0;           ///< from 0
    int leg = 0;             ///< index in legs_of()
    bool held = false;       ///< during a hold
    bool at_end = false;     ///< at the end of its leg
    Controlled by{};         ///< what is controlled
    double set = not_given;  ///< position [m] or force [N]; NaN if the stages do not determine it
    double time = 0;         ///< in a hold, since its start [s]
};
std::vector<ScanPlace> scan_places(const std::vector<Stage>& programme, const Plate& plate);

}  // namespace mcdem::scene
