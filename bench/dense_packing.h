// Compressed packings to measure on: every grain touches about six others. Made once, then read from a cache.
#pragma once
#include <filesystem>

#include "core/packing.h"

namespace mcdem::bench {

struct DensePacking {
    Packing packing;
    Box box;
    double height = 0;  ///< of the plate [m]
};

/// At most this many grains are generated; larger packings are tiled from this one.
inline constexpr int largest_generated = 50'000;

/// `count` grains in the paper's sizes: 514 in the paper's box, other counts in a cube. Above
/// `largest_generated`, mirror images of the packing of that size side by side: a grain that pressed on a
/// wall presses on its own image as hard, so that forces stay balanced. Generated packings are kept in
/// `cache`. Throws InputError for a count that cannot be tiled.
DensePacking dense_packing(int count, const std::filesystem::path& cache);

}  // namespace mcdem::bench
