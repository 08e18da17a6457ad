// The same scene with other values of some keys, for studies of what they change.
#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace mcdem::inline scene {

/// The scene with these values, as TOML text, for all its replicas. Packings and containers stay as they are:
/// keys of packing, container and batch cannot be changed, nor names, fractions and sizes of species, nor
/// grains.* where species have materials of their own. Checks the ranges of values and the conditions on
/// several keys of one material or law. Throws InputError with all problems. The text of the scene does not
/// change.
Scene with_changes(const Scene& scene, const std::map<std::string, std::string>& values);

/// Every key of the first replica with its value, in the order of the table, and the precision; then those of
/// its programme.
std::vector<std::pair<std::string, Parameter>> values_of_keys(const Scene& scene);

/// The first replica with these values, as TOML text, of any of its keys; those of the packing have no
/// effect. Numbers may leave the range of what a user may ask for. Sizes of a cylinder and of a cell do not
/// change, nor do the parameters that recordings of the replica will have. Throws InputError.
Scene variant_of(const Scene& scene, const std::map<std::string, std::string>& values);

/// The scene with the programme in a recording's parameters; none: strokes.
Scene with_programme(const Scene& scene, const Parameters& parameters);

}  // namespace mcdem::scene
