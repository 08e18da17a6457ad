// The initial packing of a replica.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/plate_face.h"

namespace mcdem::inline scene {

/// Size of a packing before it is made.
struct PackingSize {
    std::size_t grains = 0;
    double smallest = 0;  ///< smallest diameter, or a lower limit [m]
    double fastest = 0;   ///< largest speed of a centre, or of a surface about its centre [m/s]
};
PackingSize size_of(const Packing& packing);
/// For each replica. Reads packing files, each once.
std::vector<PackingSize> packing_sizes(const std::vector<Replica>& replicas);

/// A wider box was probably given in millimetres [m].
inline constexpr double widest_box = 20;

/// Reads or generates the packing and applies the jitter. In a periodic cell all centres are wrapped into the
/// cell. Throws InputError if the file is invalid or a grain is outside the container.
Packing make_packing(const Replica& replica);

/// Adds normal noise with standard deviation `sd` [m] to every coordinate of every centre.
void apply_jitter(Packing& packing, double sd, std::uint64_t seed);

/// Largest distance between centres in a neighbour list [m].
double list_reach(const Numerics& numerics, double mean_diameter, double largest_diameter);

/// If the container is too small for its grains: the key to change and its required value. A periodic cell
/// must be large enough that no two grains touch through both of its ends, and no grain touches itself.
struct TooSmall {
    std::string_view key;
    std::string what;
};
std::optional<TooSmall> too_small_container(const Box& box, const Numerics& numerics, double mean_diameter,
                                            double largest_diameter);

/// For the true grains of a replica. Throws InputError.
void expect_room(const Replica& replica, const Packing& packing);

/// Problems of a packing in this container below this plate: centres outside, sizes that cannot be in metres.
/// Each is `source: ..`; empty if there are none.
std::vector<std::string> packing_problems(const Packing& packing, const Box& box, const PlateFace& plate,
                                          const std::string& source);

}  // namespace mcdem::scene
