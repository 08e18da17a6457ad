#include "scene/packing/generate_packing.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "core/container.h"
#include "core/random.h"
#include "scene/packing/overlap_relaxation.h"
#include "scene/packing/sizes.h"

namespace mcdem::inline scene {
namespace {

double volume(double diameter) { return std::numbers::pi / 6 * diameter * diameter * diameter; }

double height_for(double grain_volume, double packing_fraction, const Box& box) {
    return grain_volume / (packing_fraction * box.size_x * box.size_y * floor_share(box));
}

/// Sizes and number of grains of each species (or of the only kind of grains).
struct Population {
    std::vector<Sizes> sizes;
    std::vector<int> counts;
};

Population population(const GeneratedPacking& wanted, const Mixture& mixture) {
    if (mixture.species.empty())
        return {{{SizeLaw::normal, wanted.diameter_mean, wanted.diameter_sd, wanted.diameter_min,
                  wanted.diameter_max, ""}},
                {wanted.count}};
    Population all;
    for (const Species& species : mixture.species) all.sizes.push_back(species.sizes);
    all.counts = species_counts(wanted.count, mixture.species, mixture.by);
    return all;
}

/// Draws the sizes of each species, in random order.
void draw_sizes(Packing& packing, const Population& population, std::uint64_t seed) {
    Random random(seed, Stream::diameters);
    std::vector<std::pair<double, int>> grains;
    for (std::size_t s = 0; s < population.sizes.size(); ++s)
        for (int i = 0; i < population.counts[s]; ++i)
            grains.emplace_back(quantile(population.sizes[s], (i + random.uniform()) / population.counts[s]),
                                static_cast<int>(s));
    random.shuffle(grains);
    for (const auto& [diameter, species] : grains) {
        packing.diameter.push_back(diameter);
        packing.species.push_back(species);
    }
}

/// Maps the square around a cylinder to its floor, keeping area fractions.
void into_cylinder(const Box& box, double margin, Vec3& point) {
    const double inner = box.size_x - 2 * margin;
    const double radius = (cylinder_radius(box) - margin) * std::sqrt((point.x() - margin) / inner);
    const double angle = 2 * std::numbers::pi * (point.y() - margin) / inner;
    point.x() = cylinder_radius(box) + radius * std::cos(angle);
    point.y() = cylinder_radius(box) + radius * std::sin(angle);
}

/// Uniform in the container, sorted into columns of four mean diameters, so that grains that are close in
/// space are close in memory.
std::vector<Vec3> draw_positions(const GeneratedPacking& wanted, const Box& box, double height,
                                 std::uint64_t seed) {
    Random random(seed, Stream::positions);
    const double margin = std::min({wanted.diameter_max, box.size_x, box.size_y, height}) / 2;
    std::vector<Vec3> position(wanted.count);
    for (Vec3& p : position) {
        for (int axis = 0; axis < 3; ++axis) {
            const double size = axis == 0 ? box.size_x : axis == 1 ? box.size_y : height;
            const double from = is_cell(box) || (is_periodic(box) && axis < 2) ? 0 : margin;
            p[axis] = random.uniform(from, size - from);
        }
        if (is_cylinder(box)) into_cylinder(box, margin, p);
    }
    const double bar = 4 * wanted.diameter_mean;
    const auto place = [bar](const Vec3& p) { return std::tuple(int(p.z() / bar), int(p.y() / bar), p.x()); };
    std::sort(position.begin(), position.end(),
              [&](const Vec3& a, const Vec3& b) { return place(a) < place(b); });
    return position;
}

}  // namespace

double expected_height(const GeneratedPacking& wanted, const Box& box, const Mixture& mixture) {
    const Population all = population(wanted, mixture);
    double grain_volume = 0;
    for (std::size_t s = 0; s < all.sizes.size(); ++s)
        grain_volume += mean_volume(all.sizes[s]) * all.counts[s];
    return height_for(grain_volume, wanted.packing_fraction, box);
}

DrawnGrains draw_grains(const GeneratedPacking& wanted, const Box& box, std::uint64_t seed,
                        const Mixture& mixture) {
    DrawnGrains drawn;
    draw_sizes(drawn.packing, population(wanted, mixture), seed);
    if (mixture.species.empty()) drawn.packing.species.clear();
    double grain_volume = 0;
    for (double d : drawn.packing.diameter) grain_volume += volume(d);
    drawn.height = is_cell(box) ? box.height : height_for(grain_volume, wanted.packing_fraction, box);
    return drawn;
}

Packing generate_packing(const GeneratedPacking& wanted, const Box& box, std::uint64_t seed,
                         const Mixture& mixture) {
    // Slow growth lets grains rearrange; more stages or iterations change little.
    constexpr int stages = 10, iterations_of_stage = 200, last_iterations = 3000;
    constexpr double smallest_scale = 0.7;

    auto [packing, height] = draw_grains(wanted, box, seed, mixture);
    packing.position = draw_positions(wanted, box, height, seed);

    OverlapRelaxation relaxation(packing, box, height);
    for (int stage = 0; stage < stages; ++stage)
        relaxation.relax(smallest_scale + (1 - smallest_scale) * stage / stages, iterations_of_stage);
    relaxation.relax(1, last_iterations);
    packing.position = relaxation.position();
    return packing;
}

}  // namespace mcdem::scene
