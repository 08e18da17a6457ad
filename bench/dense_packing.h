// Compressed packings for benchmarks, with about six contacts per grain. They are generated once and then
// read from a cache.
#pragma once
#include <filesystem>

#include "core/packing.h"

namespace mcdem::bench {

struct DensePacking {
    Packing packing;
    Box box;
    double height = 0;  ///< of the plate [m]
};

/// Maximum number of generated grains; larger packings are tiled from this one.
inline constexpr int largest_generated = 50'000;

/// `count` grains with the sizes of the paper: 514 in the paper's box, other numbers in a cube. Above
/// `largest_generated`, mirror images of the packing of that size are put together: a grain that pressed on a
/// wall presses on its own image with the same force, so forces remain balanced. Generated packings are kept
/// in `cache`. Throws InputError for a count that cannot be tiled.
DensePacking dense_packing(int count, const std::filesystem::path& cache);

}  // namespace mcdem::bench
