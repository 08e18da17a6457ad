#include "sim/layout.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "core/expects.h"

namespace mcdem::inline sim {
namespace {

/// The lowest 21 bits of `value` with two zero bits between each.
std::uint64_t spread(std::uint64_t value) {
    std::uint64_t spread = 0;
    for (int bit = 0; bit < 21; ++bit) spread |= (value >> bit & 1) << 3 * bit;
    return spread;
}

/// Grains along a Morton curve of cells one mean diameter wide; ties by grain number.
std::vector<int> spatial_order(const Packing& packing) {
    const int count = static_cast<int>(packing.size());
    const double mean = std::accumulate(packing.diameter.begin(), packing.diameter.end(), 0.0) / count;
    std::vector<std::uint64_t> code(count);
    for (int i = 0; i < count; ++i)
        for (int axis = 0; axis < 3; ++axis) {
            const double cell = std::clamp(packing.position[i][axis] / mean, 0.0, 2e6);
            code[i] |= spread(static_cast<std::uint64_t>(cell)) << axis;
        }
    std::vector<int> order(count);
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return code[a] < code[b]; });
    return order;
}

}  // namespace

std::vector<Block> Layout::blocks(int replica) const {
    std::vector<Block> all;
    for (int first = first_grain[replica]; first < first_grain[replica + 1]; first += block)
        all.push_back({replica, first});
    return all;
}

std::vector<Portion> Layout::portions(int replica) const {
    std::vector<Portion> all;
    for (int first = 0; first < grain_count[replica]; first += PORTION_GRAINS)
        all.push_back({replica, first});
    return all;
}

std::uint64_t portion_count(std::uint64_t grains) { return (grains + PORTION_GRAINS - 1) / PORTION_GRAINS; }

Layout make_layout(const std::vector<Packing>& packings, int block) {
    expects(block > 0 && !packings.empty(), "a layout has replicas and blocks");
    Layout layout;
    layout.block = block;
    layout.first_grain.push_back(0);
    for (const auto& packing : packings) {
        const int count = static_cast<int>(packing.size());
        expects(count > 0, "a replica has grains");
        const int blocks = (count + block - 1) / block;
        layout.grain_count.push_back(count);
        layout.first_grain.push_back(layout.first_grain.back() + blocks * block);
        layout.order.push_back(spatial_order(packing));
        layout.place.emplace_back(count);
        for (int k = 0; k < count; ++k) layout.place.back()[layout.order.back()[k]] = k;
    }
    return layout;
}

}  // namespace mcdem::sim
