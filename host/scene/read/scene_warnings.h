// What is valid in a scene, but perhaps not meant.
#pragma once
#include <string>
#include <vector>

#include "scene/scene.h"

namespace mcdem::inline scene {

/// Warnings about the packings of a scene that was read without problems; reads their files again.
std::vector<std::string> scene_warnings(const Scene& scene);

}  // namespace mcdem::scene
