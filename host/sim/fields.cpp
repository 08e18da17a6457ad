#include "sim/fields.h"

#include <algorithm>

#include "sim/device_types.h"

namespace mcdem::inline sim {

MemoryRows memory_rows(const FieldNeeds& needs) {
    MemoryRows rows;
    if (needs.springs) rows.count += 3;
    if (needs.springs || needs.rolling) rows.radius = rows.count++;
    if (needs.deepest) rows.deepest = rows.count++;
    if (needs.relaxed) rows.relaxed = rows.count++;
    if (needs.rolling) {
        rows.rolling = rows.count;
        rows.count += 3;
    }
    return rows;
}

template <class Make>
void Fields::visit_extents(const FieldExtents& extents, Make make) {
    const bool is_double = extents.precision == Precision::double_precision;
    const std::size_t real = is_double ? sizeof(double) : sizeof(float);
    const std::uint64_t slots = extents.grains * extents.slots;
    const auto make_pair = [&](auto& pair, std::uint64_t count, std::size_t size) {
        for (auto& copy : pair.copies) make(copy, count, size);
    };
    make(replicas, extents.replicas, is_double ? sizeof(f64::Replica) : sizeof(f32::Replica));
    make(materials, extents.replicas * extents.species,
         is_double ? sizeof(f64::Material) : sizeof(f32::Material));
    make(stop_at, extents.replicas + 1, sizeof(int));
    make(reports, extents.portions, is_double ? sizeof(f64::Report) : sizeof(f32::Report));
    make(cell_moments, extents.needs.cells ? 9 * extents.portions : 1, real);
    make(portions, extents.portions, sizeof(Portion));
    make(rebuilt, extents.portions, sizeof(Portion));
    make(blocks, extents.blocks, sizeof(Block));
    make(rebuilt_blocks, extents.blocks, sizeof(Block));
    make(first_blocks, extents.replicas, sizeof(Block));
    make_pair(motion, extents.grains, reals_of_motion * real);
    make(tracks, extents.grains, reals_of_track * real);
    make(status, extents.grains, sizeof(int));
    make(energy, extents.grains, reals_of_energy * real);
    make(partner, slots, sizeof(int));
    const std::uint64_t moving_slots = extents.needs.displacements ? slots : 1;
    make(partner_slot, moving_slots, sizeof(int));
    make_pair(displacement, moving_slots + 1, real);
    make(displacement_history, 4 * moving_slots, real);
    make(memory_of_contacts, slots * memory_rows(extents.needs).count, real);
    make(force, 3 * slots, real);
    make(overlap, slots, real);
    make(arm, slots, real);
    make(cell_head, extents.cells, sizeof(int));
    make(cell_next, extents.grains, sizeof(int));
}

FieldMemory Fields::memory_of(const FieldExtents& extents) {
    FieldMemory memory;
    Fields().visit_extents(extents, [&](auto&, std::uint64_t count, std::size_t size) {
        const std::uint64_t bytes = std::max<std::uint64_t>(count, 1) * size;
        memory.all += bytes;
        memory.largest_field = std::max(memory.largest_field, bytes);
    });
    return memory;
}

Fields::Fields(Device& device, const FieldExtents& extents) {
    visit_extents(extents, [&](auto& field, std::uint64_t count, std::size_t size) {
        field = std::remove_reference_t<decltype(field)>(device, count, size);
        memory_.all += field.bytes();
        memory_.largest_field = std::max<std::uint64_t>(memory_.largest_field, field.bytes());
    });
    const auto slots = static_cast<std::size_t>(extents.grains * extents.slots);
    has_cells_ = extents.needs.cells;
    slot_count = extents.needs.displacements ? static_cast<int>(slots) : 1;
    partner.write(std::vector<int>(slots, NO_PARTNER).data());
    partner_slot.write(std::vector<int>(static_cast<std::size_t>(slot_count), slot_count).data());
}

Kernels::Kernels(Device& device, const KernelBuild& build)
    : Kernels(device, build, build_program(device, build)) {}

Kernels::Kernels(Device& device, const KernelBuild& build, const cl::Program& program)
    : empty_cells(device, program, "empty_cells", build.list_items()),
      fill_cells(device, program, "fill_cells", build.list_items()),
      list_neighbours(device, program, "list_neighbours", build.search_items()),
      link_partner_slots(device, program, "link_partner_slots", build.list_items()),
      advance(device, program, "advance", build.work_items()),
      measure(device, program, "measure", build.work_items()),
      reduce(device, program, "reduce", 64),
      cell_stress(device, program, "cell_stress", 64) {}

}  // namespace mcdem::sim
