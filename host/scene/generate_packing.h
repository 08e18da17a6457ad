// Random packings, grown and relaxed.
#pragma once
#include <cstdint>

#include "scene/scene.h"

namespace mcdem::inline scene {

/// Species with fractions of the grains; none: all are as `GeneratedPacking` says.
struct Mixture {
    std::vector<Species> species;
    FractionsBy by = FractionsBy::number;
};
inline Mixture mixture_of(const Replica& replica) { return {replica.species, replica.packing.fractions_by}; }

/// Grains drawn at random between floor, plate and sides of a container, which is as high as the packing
/// fraction says, and pushed apart until overlaps are gone (below 1 % of the radius) or forces balance.
/// Overlaps go wherever the container has room for spheres without them: up to a packing fraction of about
/// 0.62 far from walls, 0.57 in a box eight diameters wide, where walls keep grains apart. Above that what
/// remains is the overlap that compression to this packing fraction demands: at 0.60, 0.62 and 0.70 in such a
/// box at most about 9, 15 and 30 % of the radius.
///
/// The same seed gives the same packing, bit for bit, on the same machine. Sizes follow the stated
/// distribution closely (one grain from each of `count` equally likely ranges), so that packings of
/// different seeds hold nearly the same volume.
/// Where there are species, each has its share of the grains and its sizes; which grain is of which is left
/// to chance.
Packing generate_packing(const GeneratedPacking& wanted, const Box& box, std::uint64_t seed,
                         const Mixture& mixture = {});

/// Height of the box that `generate_packing` would fill, for sizes exactly as distributed [m].
double expected_height(const GeneratedPacking& wanted, const Box& box, const Mixture& mixture = {});

}  // namespace mcdem::scene
