// Memory and integer ranges that a batch needs, computed before anything is allocated.
#pragma once
#include <vector>

#include "cl/program.h"
#include "scene/packing/make_packing.h"
#include "sim/fields.h"

namespace mcdem::inline sim {

/// Representable in single precision [s].
inline constexpr double min_time_step = 1e-30;

/// "3.78 MB"
std::string memory_text(std::uint64_t bytes);

/// Upper limit of the device memory of the batch; its cell lists may be smaller.
FieldMemory memory_needed(Precision precision, int slots, const std::vector<Replica>& replicas,
                          const std::vector<PackingSize>& sizes);

/// Optional fields that a batch of these replicas needs.
FieldNeeds field_needs(const std::vector<Replica>& replicas);

/// Extents of all fields of a batch. `cells`: total over all replicas.
FieldExtents field_extents(const KernelBuild& build, const std::vector<Replica>& replicas,
                           const std::vector<PackingSize>& sizes, std::uint64_t cells);

/// Throws InputError if the device does not have enough memory for the batch, or if a counter would overflow.
void expect_within_limits(const DeviceInfo& device, const KernelBuild& build,
                          const std::vector<Replica>& replicas, const std::vector<PackingSize>& sizes);

/// Throws InputError if the protocol has too many steps to count, or the steps are too short.
void expect_countable_steps(const Replica& replica, double time_step);

/// Throws InputError if a grain would move at the start farther in a time step [s] than neighbour lists of
/// the smallest grains allow.
void expect_slow_grains(const Replica& replica, const PackingSize& size, double time_step);

/// All checks, as far as possible before packings are generated.
void expect_runnable(const Device& device, const Scene& scene);

}  // namespace mcdem::sim
