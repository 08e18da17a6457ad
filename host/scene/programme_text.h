// A programme as the parameters of a recording have it, and where in it each of its scans is taken.
#pragma once
#include <toml++/toml.h>

#include <map>
#include <string>
#include <vector>

#include "scene/legs.h"

namespace mcdem::inline scene {

/// "programme.1.stage" and the other keys of all stages with their values.
std::map<std::string, std::string> programme_parameters(const std::vector<Stage>& programme);

/// The stages in a recording's parameters; none where it was taken through strokes. Throws
/// InputError where they are none that a scene can have said.
std::vector<Stage> programme_of(const std::map<std::string, std::string>& parameters);

/// [[programme]]: of each stage what it says beyond the defaults.
toml::array programme_tables(const std::vector<Stage>& programme);

/// What a scan of a programme is taken of. Scan n + 1 of a recording, for scan 0 is the packing at rest.
struct ScanPlace {
    int stage = 0;           ///< from 0
    int leg = 0;             ///< of legs_of()
    bool held = false;       ///< during a hold
    bool at_end = false;     ///< of its leg
    Controlled by{};         ///< what is controlled
    double set = not_given;  ///< position [m] or force [N]; not-a-number where the stages do not say it
    double time = 0;         ///< of a hold, since it began [s]
};
std::vector<ScanPlace> scan_places(const std::vector<Stage>& programme, const Plate& plate);

}  // namespace mcdem::scene
