#include "scene/packing/packing_state.h"

#include <algorithm>
#include <numeric>

#include "core/law_range.h"
#include "core/median.h"
#include "core/near_pairs.h"

namespace mcdem::inline scene {

PackingState packing_state(const Packing& packing, const Box& box, const PlateFace& plate) {
    PackingState state;
    double sides = 0;
    const auto add = [&](double overlap, double diameter, double count) {
        if (overlap <= 0) return;
        sides += count;
        if (overlap <= state.deepest_overlap) return;
        state.deepest_overlap = overlap;
        state.relative_overlap = overlap / diameter;
    };
    for (std::size_t i = 0; i < packing.size(); ++i) {
        const Vec3& at = packing.position[i];
        const double diameter = packing.diameter[i];
        for (int wall = 0; wall < static_cast<int>(Wall::plate); ++wall)
            if (has_wall(box, static_cast<Wall>(wall)))
                add(diameter / 2 - wall_distance(box, static_cast<Wall>(wall), plate.z, at), diameter, 1);
        if (!is_cell(box)) add(diameter / 2 - (plate.foot(at) - at).norm(), diameter, 1);
    }
    const double widest = packing.size() == 0 ? 0 : *std::ranges::max_element(packing.diameter);
    NeighbourGrid(packing.position, box, plate.z, widest).for_each_pair([&](int i, int j) {
        const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
        const double first = packing.diameter[a], second = packing.diameter[b];
        add((first + second) / 2 - apart(box, packing.position[a], packing.position[b]).norm(),
            std::min(first, second), 2);
    });
    state.coordination_number = packing.size() == 0 ? 0 : sides / static_cast<double>(packing.size());
    return state;
}

DeepestPair deepest_pair(const Packing& packing, const Box& box, double height) {
    DeepestPair deepest;
    if (packing.size() < 2) return deepest;
    std::vector<Vec3> inside;
    for (const Vec3& position : packing.position) inside.push_back(into_cell(box, position));
    const double reach = std::min(4 * median(packing.diameter), *std::ranges::max_element(packing.diameter));
    NeighbourGrid(inside, box, height, reach).for_each_pair([&](int i, int j) {
        const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
        const double one = packing.diameter[a] / 2, other = packing.diameter[b] / 2;
        const double overlap =
            relative_overlap(one + other - apart(box, inside[a], inside[b]).norm(), one, other);
        if (overlap > deepest.overlap) deepest = {std::min(a, b), std::max(a, b), overlap};
    });
    return deepest;
}

MostNeighbours most_neighbours(const Packing& packing, const Box& box, double height, double gap) {
    MostNeighbours most;
    if (packing.size() == 0) return most;
    std::vector<Vec3> inside;
    for (const Vec3& position : packing.position) inside.push_back(into_cell(box, position));
    const double reach =
        std::min(10 * median(packing.diameter), *std::ranges::max_element(packing.diameter)) + gap;
    std::vector<std::size_t> count(packing.size(), 0);
    for (std::size_t i = 0; i < packing.size(); ++i)
        for (int wall = 0; wall < static_cast<int>(Wall::plate); ++wall)
            if (has_wall(box, static_cast<Wall>(wall)))
                count[i] += wall_distance(box, static_cast<Wall>(wall), height, inside[i]) <
                            packing.diameter[i] / 2 + gap;
    NeighbourGrid(inside, box, height, reach).for_each_pair([&](int i, int j) {
        const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
        const double within = (packing.diameter[a] + packing.diameter[b]) / 2 + gap;
        if (apart(box, inside[a], inside[b]).squaredNorm() >= within * within) return;
        ++count[a];
        ++count[b];
    });
    const auto found = std::ranges::max_element(count);
    return {static_cast<std::size_t>(found - count.begin()), *found};
}

double list_gap(const Numerics& numerics, const Packing& packing) {
    const double sum = std::accumulate(packing.diameter.begin(), packing.diameter.end(), 0.0);
    return (numerics.probe_gap + numerics.skin) * sum / (2 * static_cast<double>(packing.size()));
}

}  // namespace mcdem::scene
