// The two kernels of the cell list: every grain is in the list of its cell exactly once.
#include <cmath>

#include "reference/test_scene.h"
#include "sim/device_replica.h"

namespace mcdem::reference {
namespace {

/// Fields of a batch (float) with positions and replicas uploaded.
struct CellScene {
    explicit CellScene(const std::vector<Start>& starts)
        : kernels(build(Precision::single_precision)),
          layout(mcdem::make_layout(each(starts, &Start::packing), kernels.block())) {
        int cells = 0;
        for (int r = 0; r < layout.replicas(); ++r) {
            replicas.push_back(mcdem::device_replica<mcdem::f32::Replica>(
                starts[r].replica, starts[r].packing, {layout.first_grain[r], layout.grain_count[r], cells}));
            cells += mcdem::cell_count(replicas.back());
        }
        cell_head.assign(cells, 12345);
        cell_next.assign(layout.grains(), 12345);
        motion.assign(mcdem::reals_of_motion * layout.grains(), 0);
        for (int r = 0; r < layout.replicas(); ++r)
            for (int k = 0; k < layout.grain_count[r]; ++k) {
                const int grain = layout.order[r][k];
                float* at = &motion[mcdem::reals_of_motion * (layout.first_grain[r] + k)];
                for (int axis = 0; axis < 3; ++axis)
                    at[axis] = float(starts[r].packing.position[grain][axis]);
                at[3] = float(starts[r].packing.diameter[grain] / 2);
            }
    }

    void fill(const std::vector<int>& chosen) {
        mcdem::FieldExtents extents;
        extents.replicas = replicas.size();
        extents.blocks = static_cast<std::uint64_t>(layout.grains() / layout.block);
        for (int count : layout.grain_count) extents.portions += mcdem::portion_count(count);
        extents.grains = layout.grains();
        extents.cells = cell_head.size();
        extents.slots = kernels.slots;
        mcdem::Fields fields(device(), extents);
        mcdem::Kernels program(device(), kernels);
        fields.replicas.write(replicas.data());
        fields.motion.copies[0].write(motion.data());
        fields.cell_head.write(cell_head.data());
        fields.cell_next.write(cell_next.data());
        std::vector<mcdem::Block> blocks;
        std::vector<mcdem::Portion> portions;
        for (int r : chosen) {
            std::ranges::copy(layout.blocks(r), std::back_inserter(blocks));
            std::ranges::copy(layout.portions(r), std::back_inserter(portions));
        }
        fields.rebuilt.write(portions.data(), 0, portions.size() * sizeof(mcdem::Portion));
        fields.rebuilt_blocks.write(blocks.data(), 0, blocks.size() * sizeof(mcdem::Block));
        program.empty_cells(portions.size(), fields.replicas, fields.rebuilt, fields.cell_head);
        program.fill_cells(blocks.size(), static_cast<int>(blocks.size()), fields.replicas,
                           fields.rebuilt_blocks, fields.motion.now(0), fields.cell_head, fields.cell_next);
        fields.cell_head.read(cell_head.data());
        fields.cell_next.read(cell_next.data());
    }

    KernelBuild kernels;
    mcdem::Layout layout;
    std::vector<mcdem::f32::Replica> replicas;
    std::vector<int> cell_head, cell_next;
    std::vector<float> motion;
};

int cell_along(float x, float size, int cells) {
    return std::min(std::max(int(std::floor(x / size)), 0), cells - 1);
}

void expect_cells(const CellScene& scene, int r) {
    const auto& replica = scene.replicas[r];
    std::vector<int> seen(scene.layout.grains(), 0);
    for (int cell = 0; cell < mcdem::cell_count(replica); ++cell)
        for (int grain = scene.cell_head[replica.first_cell + cell]; grain >= 0;
             grain = scene.cell_next[grain]) {
            ASSERT_LT(grain, scene.layout.grains());
            ASSERT_EQ(seen[grain]++, 0) << "grain " << grain << " is in a cell twice";
            const float* x = &scene.motion[mcdem::reals_of_motion * grain];
            const int expected =
                (cell_along(x[2], replica.cell_size[0], replica.span_z) % replica.cells_z * replica.cells_y +
                 cell_along(x[1], replica.cell_size[0], replica.span_y) % replica.cells_y) *
                    replica.cells_x +
                cell_along(x[0], replica.cell_size[0], replica.span_x) % replica.cells_x;
            EXPECT_EQ(cell, expected) << "grain " << grain;
        }
    for (int k = 0; k < replica.grain_count; ++k)
        EXPECT_EQ(seen[replica.first_grain + k], 1) << "grain " << k;
}

TEST(CellList, HoldsEveryGrainOnceInItsCell) {
    std::vector<Start> starts;
    for (int count : {1, 63, 64, 65, 4096, 9000})
        starts.push_back(jittered_lattice(test_replica(), count, count));
    starts[1].packing.position[5].x() = -0.001;  // outside the box: belongs to the nearest cell
    starts[1].packing.position[6].z() = 0.5;
    CellScene scene(starts);
    scene.fill({0, 1, 2, 3, 4, 5});
    for (int r = 0; r < 6; ++r) expect_cells(scene, r);
}

TEST(CellList, LeavesOtherReplicasAlone) {
    std::vector<Start> starts;
    for (int r = 0; r < 3; ++r) starts.push_back(jittered_lattice(test_replica(), 65, r));
    CellScene scene(starts);
    scene.fill({1});
    expect_cells(scene, 1);
    const auto& replica = scene.replicas[1];
    for (int cell = 0; cell < int(scene.cell_head.size()); ++cell) {
        const bool elsewhere = cell < replica.first_cell || cell >= scene.replicas[2].first_cell;
        EXPECT_TRUE(!elsewhere || scene.cell_head[cell] == 12345) << "cell " << cell;
    }
    for (int k = 0; k < scene.layout.first_grain[1]; ++k) EXPECT_EQ(scene.cell_next[k], 12345);
}

}  // namespace
}  // namespace mcdem::reference
