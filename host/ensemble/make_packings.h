// Initial packings of all replicas of a scene.
#pragma once
#include <functional>
#include <vector>

#include "scene/scene.h"

namespace mcdem::inline ensemble {

/// One packing per replica, in order, computed on all cores; replicas with the same initial packing share the
/// work. Throws InputError with all problems. Stops, with fewer packings than replicas, when `stop_wanted`
/// returns true (called from several threads).
std::vector<Packing> make_packings(const Scene& scene, const std::function<bool()>& stop_wanted = {});

}  // namespace mcdem::ensemble
