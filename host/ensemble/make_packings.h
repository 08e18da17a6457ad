// The packings that all replicas of a scene start from.
#pragma once
#include <functional>
#include <vector>

#include "scene/scene.h"

namespace mcdem::inline ensemble {

/// One packing a replica, in the scene's order, made on all cores; replicas that start alike share the
/// work. Throws InputError with what is wrong in any of them. Gives up, with fewer packings than
/// replicas, once `stop_wanted` says so (asked by several threads).
std::vector<Packing> make_packings(const Scene& scene, const std::function<bool()>& stop_wanted = {});

}  // namespace mcdem::ensemble
