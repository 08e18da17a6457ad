// The same scene with other values of some keys, for studies of what they change.
#pragma once
#include <map>
#include <string>

#include "scene/scene.h"

namespace mcdem::inline scene {

/// The scene with these values, as TOML text, for all its replicas. Packings and containers stay as they are:
/// keys of packing, container and batch cannot be changed, nor names, fractions and sizes of species, nor
/// grains.* where species have materials of their own. Checks the ranges of values and the conditions on
/// several keys of one material or law. Throws InputError with all problems. The text of the scene does not
/// change.
Scene with_changes(const Scene& scene, const std::map<std::string, std::string>& values);

}  // namespace mcdem::scene
