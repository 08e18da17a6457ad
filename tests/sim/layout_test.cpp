// Order of grains in memory.
#include "sim/layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "reference/test_scene.h"

namespace mcdem::reference {
namespace {

TEST(Layout, PadsEveryReplicaToWholeBlocks) {
    std::vector<Packing> packings;
    for (int count : {1, 16, 17, 64, 65})
        packings.push_back(jittered_lattice(test_replica(), count, 1).packing);
    const auto layout = mcdem::make_layout(packings, 16);
    EXPECT_EQ(layout.first_grain, (std::vector<int>{0, 16, 32, 64, 128, 208}));
    EXPECT_EQ(layout.grain_count, (std::vector<int>{1, 16, 17, 64, 65}));
    std::vector<std::pair<int, int>> blocks;  // replica and first grain
    for (int r = 0; r < layout.replicas(); ++r)
        for (const mcdem::Block& block : layout.blocks(r)) blocks.emplace_back(block.replica, block.first);
    EXPECT_EQ(blocks, (std::vector<std::pair<int, int>>{{0, 0},
                                                        {1, 16},
                                                        {2, 32},
                                                        {2, 48},
                                                        {3, 64},
                                                        {3, 80},
                                                        {3, 96},
                                                        {3, 112},
                                                        {4, 128},
                                                        {4, 144},
                                                        {4, 160},
                                                        {4, 176},
                                                        {4, 192}}));
    EXPECT_EQ(layout.block_count(4), 5);
    EXPECT_EQ(layout.grains(), 208);
}

TEST(Layout, OrderContainsEveryGrainOnce) {
    const auto layout = mcdem::make_layout({jittered_lattice(test_replica(), 1000, 2).packing}, 16);
    auto order = layout.order[0];
    std::sort(order.begin(), order.end());
    std::vector<int> all(1000);
    std::iota(all.begin(), all.end(), 0);
    EXPECT_EQ(order, all);
}

// Each block of 16 out of 1000 shuffled grains spans two or three diameters, not the whole box.
TEST(Layout, GrainsOfABlockAreCloseToEachOther) {
    Packing packing = jittered_lattice(test_replica(), 1000, 3).packing;
    for (std::size_t i = 0; i < 1000; ++i) std::swap(packing.position[i], packing.position[i * 7919 % 1000]);
    const auto layout = mcdem::make_layout({packing}, 16);
    double mean = 0;
    for (int k = 0; k < 1000; ++k)
        mean +=
            (packing.position[layout.order[0][k]] - packing.position[layout.order[0][k / 16 * 16]]).norm() /
            1000;
    EXPECT_LT(mean, 3 * 0.02);
    EXPECT_GT(mean, 0);
}

}  // namespace
}  // namespace mcdem::reference
