// Positions of the grains of all replicas in the device's arrays: replica after replica, each padded to whole
// blocks; grains that are close in space are close in memory.
#pragma once
#include <cstdint>
#include <vector>

#include "core/packing.h"
#include "sim/device_types.h"

namespace mcdem::inline sim {

struct Layout {
    int block = 16;                       ///< grains per block
    std::vector<int> first_grain;         ///< of each replica, plus the end of the last one
    std::vector<int> grain_count;         ///< of each replica
    std::vector<std::vector<int>> order;  ///< replica, position in the array -> the user's grain number
    std::vector<std::vector<int>> place;  ///< the inverse

    int replicas() const { return static_cast<int>(grain_count.size()); }
    int grains() const { return first_grain.back(); }  ///< padded, all replicas
    int block_count(int replica) const { return (first_grain[replica + 1] - first_grain[replica]) / block; }
    std::vector<Block> blocks(int replica) const;
    /// Portions of a replica's grains for sums by work-groups.
    std::vector<Portion> portions(int replica) const;
};

/// Number of portions of that many grains.
std::uint64_t portion_count(std::uint64_t grains);

Layout make_layout(const std::vector<Packing>& packings, int block);

}  // namespace mcdem::sim
