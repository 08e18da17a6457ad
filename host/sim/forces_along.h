// Contact forces between grains that move along a prescribed path.
#pragma once
#include <vector>

#include "core/stop.h"
#include "sim/engine.h"

namespace mcdem::inline sim {

/// The contact forces on the grains of `packing` at the times `time` [s], at which they have the positions
/// and velocities of `path`; the packing's own are not used. `scene` must have one replica; its plate stands
/// still at plate.start. The contacts' memory advances from each time to the next by one step, in which the
/// grains have the velocities at its end: as in the leapfrog integration, these are best those of half a step
/// before. At the first time contacts have no memory. Surface displacements are extrapolated from earlier
/// times, as in a run. Throws InputError for a path that is not finite, leaves the container, overlaps too
/// much, or moves a grain in one step farther than half the margin of neighbour lists; Interrupted.
std::vector<GrainForces> forces_along(Device& device, const Scene& scene, Packing packing,
                                      const std::vector<double>& time, const std::vector<GrainMotion>& path,
                                      const StopWanted& stop_wanted = never_stop);

}  // namespace mcdem::sim
