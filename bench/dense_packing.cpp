#include "bench/dense_packing.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "core/atomic_file.h"
#include "core/errors.h"
#include "scene/packing/generate_packing.h"
#include "scene/packing/read_packing.h"

namespace mcdem::bench {
namespace {

constexpr std::uint64_t seed = 1;
constexpr int paper_count = 514;
/// Packing fraction with about six contacts per grain far from walls. In a small box it is lower, because
/// walls keep grains apart: the missing layer next to the walls, in diameters.
constexpr double inner_fraction = 0.645, lacking_layer = 0.46;

double side_of_cube(const GeneratedPacking& what) {
    return std::cbrt(expected_height(what, Box{1, 1}));
}  // [m]

GeneratedPacking wanted(int count) {
    GeneratedPacking what;
    what.count = count;
    what.packing_fraction = inner_fraction;
    what.packing_fraction *= 1 - lacking_layer * what.diameter_mean / side_of_cube(what);
    return what;
}

Box box_for(int count) {
    if (count == paper_count) return Replica{}.box;
    const double side = side_of_cube(wanted(count));
    return {side, side};
}

double grain_volume(const Packing& packing) {
    double volume = 0;
    for (double d : packing.diameter) volume += std::numbers::pi / 6 * d * d * d;
    return volume;
}

std::string as_csv(const Packing& packing) {
    std::string text = "x_m,y_m,z_m,diameter_m\n";
    for (std::size_t i = 0; i < packing.size(); ++i) {
        const Vec3& p = packing.position[i];
        text += fmt::format("{},{},{},{}\n", p.x(), p.y(), p.z(), packing.diameter[i]);
    }
    return text;
}

DensePacking generated(int count, const std::filesystem::path& cache) {
    DensePacking dense;
    dense.box = box_for(count);
    const GeneratedPacking what = wanted(count);
    const auto file = cache / fmt::format("dense_{}_{:.4f}_{}.csv", count, what.packing_fraction, seed);
    if (!std::filesystem::exists(file)) {
        std::filesystem::create_directories(cache);
        replace_file(file, as_csv(generate_packing(what, dense.box, seed)));
    }
    dense.packing = read_packing(file);
    dense.height =
        grain_volume(dense.packing) / (what.packing_fraction * dense.box.size_x * dense.box.size_y);
    return dense;
}

/// Coordinate in tile `index` along an axis: every other tile is a mirror image.
double tiled(double coordinate, double size, int index) {
    return index * size + (index % 2 ? size - coordinate : coordinate);
}

DensePacking tile(const DensePacking& one, std::array<int, 3> tiles) {
    DensePacking all;
    all.box = {one.box.size_x * tiles[0], one.box.size_y * tiles[1]};
    all.height = one.height * tiles[2];
    for (int k = 0; k < tiles[2]; ++k)
        for (int j = 0; j < tiles[1]; ++j)
            for (int i = 0; i < tiles[0]; ++i)
                for (std::size_t grain = 0; grain < one.packing.size(); ++grain) {
                    const Vec3& p = one.packing.position[grain];
                    all.packing.position.emplace_back(tiled(p.x(), one.box.size_x, i),
                                                      tiled(p.y(), one.box.size_y, j),
                                                      tiled(p.z(), one.height, k));
                    all.packing.diameter.push_back(one.packing.diameter[grain]);
                }
    return all;
}

/// Numbers of tiles along x, y, z, as close to a cube as possible.
std::array<int, 3> tiles_for(int tiles) {
    std::array<int, 3> best{tiles, 1, 1};
    for (int i = 1; i <= tiles; ++i)
        for (int j = 1; j <= i; ++j) {
            if (tiles % (i * j)) continue;
            const int k = tiles / (i * j);
            if (k <= j && i - k < best[0] - best[2]) best = {i, j, k};
        }
    return best;
}

}  // namespace

DensePacking dense_packing(int count, const std::filesystem::path& cache) {
    if (count <= largest_generated) return generated(count, cache);
    if (count % largest_generated)
        throw InputError(fmt::format("dense_packing: above {0} the count must be a multiple of {0}, got {1}",
                                     largest_generated, count));
    return tile(generated(largest_generated, cache), tiles_for(count / largest_generated));
}

}  // namespace mcdem::bench
