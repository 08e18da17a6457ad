// Where the grains of all replicas lie in the device's arrays: replica after replica, each padded to whole
// blocks, neighbours in space close in memory.
#pragma once
#include <cstdint>
#include <vector>

#include "core/packing.h"
#include "sim/device_types.h"

namespace mcdem::inline sim {

struct Layout {
    int block = 16;                ///< grains a block
    std::vector<int> first_grain;  ///< of each replica; one more for the end of the last
    std::vector<int> grain_count;  ///< of each replica
    std::vector<int> replica_of_block;
    std::vector<std::vector<int>> order;  ///< replica, place -> the user's grain number

    int replicas() const { return static_cast<int>(grain_count.size()); }
    int grains() const { return first_grain.back(); }  ///< padded, all replicas
    int first_block(int replica) const { return first_grain[replica] / block; }
    /// What the grains of a replica are divided into where work-groups sum them up.
    std::vector<Portion> portions(int replica) const;
    /// Where each of the user's grains is within its replica: the inverse of order.
    std::vector<int> places(int replica) const;
};

/// Portions of so many grains.
std::uint64_t portion_count(std::uint64_t grains);

Layout make_layout(const std::vector<Packing>& packings, int block);

}  // namespace mcdem::sim
