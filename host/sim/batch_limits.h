// What a batch asks of its device and of the integers that count it, known before anything is allocated.
#pragma once
#include <vector>

#include "cl/program.h"
#include "scene/make_packing.h"
#include "sim/fields.h"

namespace mcdem::inline sim {

/// "3.78 MB"
std::string memory_text(std::uint64_t bytes);

/// Device memory that the batch needs at most: its cell lists may turn out smaller.
FieldMemory memory_needed(Precision precision, int slots, const std::vector<Replica>& replicas,
                          const std::vector<PackingSize>& sizes);

/// Which optional fields a batch of these needs.
FieldNeeds field_needs(const std::vector<Replica>& replicas);

/// All fields of a batch. `cells`: of all replicas.
FieldExtents field_extents(const KernelBuild& build, const std::vector<Replica>& replicas,
                           const std::vector<PackingSize>& sizes, std::uint64_t cells);

/// Throws InputError where the device has not the memory for a batch, or a number that counts something in it
/// would overflow.
void expect_within_limits(const DeviceInfo& device, const KernelBuild& build,
                          const std::vector<Replica>& replicas, const std::vector<PackingSize>& sizes);

/// Throws InputError for a protocol of more steps than can be counted, or of steps too short.
void expect_countable_steps(const Replica& replica, double time_step);

/// Both, as far as can be told before packings are made.
void expect_runnable(const Device& device, const Scene& scene);

}  // namespace mcdem::sim
