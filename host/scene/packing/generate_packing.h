// Generation of random packings.
#pragma once
#include <cstdint>

#include "scene/scene.h"

namespace mcdem::inline scene {

/// Species with fractions of the grains; empty: all grains follow `GeneratedPacking`.
struct Mixture {
    std::vector<Species> species;
    FractionsBy by = FractionsBy::number;
};
inline Mixture mixture_of(const Replica& replica) { return {replica.species, replica.packing.fractions_by}; }

/// Draws grains at random between floor, plate and sides of a container, whose height follows from the
/// packing fraction. The grains are pushed apart until overlaps are gone (below 1 % of the radius) or forces
/// balance. Overlaps vanish if the container has room for spheres without them: up to a packing fraction of
/// about 0.62 far from walls, and 0.57 in a box that is eight diameters wide, where walls keep grains apart.
/// Above that the remaining overlap is the one required by compression to this packing fraction: at 0.60,
/// 0.62 and 0.70 in such a box at most about 9, 15 and 30 % of the radius.
///
/// The same seed gives the same packing, bit for bit, on the same machine. Sizes follow the stated
/// distribution closely (one grain from each of `count` equally likely ranges), so packings of different
/// seeds have nearly the same volume. Each species gets its fraction of the grains and its sizes; the
/// assignment to grains is random.
Packing generate_packing(const GeneratedPacking& wanted, const Box& box, std::uint64_t seed,
                         const Mixture& mixture = {});

/// The grains of such a packing, not yet placed, and the height that they will fill [m].
struct DrawnGrains {
    Packing packing;
    double height = 0;
};
DrawnGrains draw_grains(const GeneratedPacking& wanted, const Box& box, std::uint64_t seed,
                        const Mixture& mixture = {});

/// Height of the box that `generate_packing` would fill with sizes exactly as distributed [m].
double expected_height(const GeneratedPacking& wanted, const Box& box, const Mixture& mixture = {});

}  // namespace mcdem::scene
