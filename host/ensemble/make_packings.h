// Initial packings of all replicas of a scene.
#pragma once
#include <vector>

#include "core/stop.h"
#include "scene/scene.h"

namespace mcdem::inline ensemble {

/// One packing per replica, in order, computed on all cores; replicas with the same initial packing share the
/// work. Throws InputError with all problems, Interrupted.
std::vector<Packing> make_packings(const Scene& scene, const StopWanted& stop_wanted = never_stop);

}  // namespace mcdem::ensemble
