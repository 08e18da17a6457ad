#include "sim/fields.h"

namespace mcdem {

Fields::Fields(Device& device, const KernelBuild& build, const Layout& layout, std::size_t replica_bytes,
               std::size_t report_bytes, int cells, FieldNeeds needs) {
    const std::size_t real = build.real_size();
    const std::size_t grains = layout.grains();
    const std::size_t slots = grains * build.slots;
    const std::size_t replica_count = layout.replicas();
    const std::size_t block_count = layout.replica_of_block.size();
    const auto make = [&](auto& field, std::size_t count, std::size_t size) {
        field = std::remove_reference_t<decltype(field)>(device, count, size);
        bytes_ += field.bytes();
    };
    const auto make_pair = [&](auto& pair, std::size_t count, std::size_t size) {
        for (auto& copy : pair.copies) make(copy, count, size);
    };
    make(replicas, replica_count, replica_bytes);
    make(stop_at, replica_count, sizeof(int));
    make(reports, replica_count, report_bytes);
    make(chosen, replica_count, sizeof(int));
    make(relisted, replica_count, sizeof(int));
    make(blocks, block_count, sizeof(int));
    make(relisted_blocks, block_count, sizeof(int));
    make(replica_of_block, block_count, sizeof(int));
    replica_of_block.write(layout.replica_of_block.data());
    make_pair(position, grains, 4 * real);
    make_pair(velocity, grains, 4 * real);
    make_pair(angular_velocity, grains, 4 * real);
    make(listed_position, grains, 4 * real);
    make(status, grains, sizeof(int));
    make(energy, grains, 4 * real);
    make(partner, slots, sizeof(int));
    const std::size_t bulge_slots = needs.bulges ? slots : 1;
    make(mirror, bulge_slots, sizeof(int));
    slot_count = static_cast<int>(bulge_slots);
    make_pair(bulge, bulge_slots + 1, real);
    make(bulge_history, 4 * bulge_slots, real);
    const std::size_t spring_slots = needs.springs ? slots : 1;
    make(spring_x, spring_slots, real);
    make(spring_y, spring_slots, real);
    make(spring_z, spring_slots, real);
    make(deepest, needs.deepest ? slots : 1, real);
    make(relaxed, needs.relaxed ? slots : 1, real);
    make(force_x, slots, real);
    make(force_y, slots, real);
    make(force_z, slots, real);
    make(overlap, slots, real);
    make(arm, slots, real);
    make(cell_head, cells, sizeof(int));
    make(cell_next, grains, sizeof(int));
    partner.write(std::vector<int>(slots, -1).data());
    mirror.write(std::vector<int>(bulge_slots, slot_count).data());
}

Kernels::Kernels(Device& device, const KernelBuild& build) : Kernels(device, build_program(device, build)) {}

Kernels::Kernels(Device& device, const cl::Program& program)
    : empty_cells(device, program, "empty_cells"),
      fill_cells(device, program, "fill_cells"),
      list_neighbours(device, program, "list_neighbours"),
      link_mirrors(device, program, "link_mirrors"),
      advance(device, program, "advance"),
      measure(device, program, "measure"),
      reduce(device, program, "reduce") {}

}  // namespace mcdem
