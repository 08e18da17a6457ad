#include "scene/packing_state.h"

#include <algorithm>
#include <array>

#include "scene/cell_pairs.h"

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
        const double diameter = packing.diameter[i], to_plate = (plate.foot(at) - at).norm();
        for (const double distance :
             {at.x(), box.size_x - at.x(), at.y(), box.size_y - at.y(), at.z(), to_plate})
            add(diameter / 2 - distance, diameter, 1);
    }
    const double widest = packing.size() == 0 ? 0 : *std::ranges::max_element(packing.diameter);
    CellList(packing.position, {box.size_x, box.size_y, plate.z}, widest).for_each_pair([&](int i, int j) {
        const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
        const double first = packing.diameter[a], second = packing.diameter[b];
        add((first + second) / 2 - (packing.position[a] - packing.position[b]).norm(),
            std::min(first, second), 2);
    });
    state.coordination_number = packing.size() == 0 ? 0 : sides / static_cast<double>(packing.size());
    return state;
}

}  // namespace mcdem::scene
