// The packing that a replica starts from.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/plate_face.h"

namespace mcdem::inline scene {

/// What is known of a packing before it is made.
struct PackingSize {
    std::size_t grains = 0;
    double smallest = 0;  ///< diameter, or a limit below it [m]
};
PackingSize size_of(const Packing& packing);
/// Of each replica. Reads packing files, each once.
std::vector<PackingSize> packing_sizes(const std::vector<Replica>& replicas);

/// A wider box may have been given in millimetres [m].
inline constexpr double widest_box = 20;

/// Read or generated, then jittered. Throws InputError where the file is bad or a grain is out of the box.
Packing make_packing(const Replica& replica);

/// Moves every coordinate of every centre by a normal random length with standard deviation `sd` [m].
void apply_jitter(Packing& packing, double sd, std::uint64_t seed);

/// What is wrong with a packing in this box, below this plate: centres outside, sizes that cannot be metres.
/// Each is `source: ..`; empty where all is well.
std::vector<std::string> packing_problems(const Packing& packing, const Box& box, const PlateFace& plate,
                                          const std::string& source);

}  // namespace mcdem::scene
