// The packing that a replica starts from.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
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

/// Read or generated, then jittered; in a periodic cell every centre in the cell itself. Throws InputError
/// where the file is bad or a grain is out of the container.
Packing make_packing(const Replica& replica);

/// Moves every coordinate of every centre by a normal random length with standard deviation `sd` [m].
void apply_jitter(Packing& packing, double sd, std::uint64_t seed);

/// How far centres may be apart in a neighbour list, at most [m].
double list_reach(const Numerics& numerics, double mean_diameter, double largest_diameter);

/// Where the container is too small for its grains: the key to blame, and what it must be. A periodic cell
/// must keep every two grains from meeting twice, over both ends, and a grain from meeting itself.
struct TooSmall {
    std::string_view key;
    std::string what;
};
std::optional<TooSmall> too_small_container(const Box& box, const Numerics& numerics, double mean_diameter,
                                            double largest_diameter);

/// Of the true grains of a replica. Throws InputError.
void expect_room(const Replica& replica, const Packing& packing);

/// What is wrong with a packing in this container, below this plate: centres outside, sizes that cannot be
/// metres. Each is `source: ..`; empty where all is well.
std::vector<std::string> packing_problems(const Packing& packing, const Box& box, const PlateFace& plate,
                                          const std::string& source);

}  // namespace mcdem::scene
