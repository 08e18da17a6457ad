#include "sim/batch_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/container.h"
#include "core/errors.h"
#include "scene/programme/legs.h"
#include "sim/device_material.h"
#include "sim/device_replica.h"
#include "sim/expected_run.h"
#include "sim/layout.h"

namespace mcdem::inline sim {
namespace {

constexpr std::uint64_t max_int = std::numeric_limits<int>::max();
constexpr double max_steps = 1e11;  // times 1e7 grains it fits into a long

/// Advice for a batch of this many replicas if only the fraction `part` of it fits.
std::string remedy(std::size_t replicas, double part) {
    const auto fitting = static_cast<std::size_t>(part * static_cast<double>(replicas));
    if (replicas > 1 && fitting > 0)
        return fmt::format("take at most {} replicas in one go (`mcdem run .. --part-replicas {}`)", fitting,
                           fitting);
    return "take fewer grains, fewer numerics.slots, numerics.precision = \"float\", or a device with more "
           "memory";
}

void expect_room(const DeviceInfo& device, const FieldMemory& memory, std::size_t replicas) {
    const auto expect = [&](const char* what, std::uint64_t needed, std::uint64_t there) {
        if (needed <= there) return;
        const double part = static_cast<double>(there) / static_cast<double>(needed);
        throw InputError(
            fmt::format("batch.replicas: {} on {} must be at most {}, got {} for {} replica{}: {}", what,
                        device.name, memory_text(there), memory_text(needed), replicas,
                        replicas == 1 ? "" : "s", remedy(replicas, part)));
    };
    expect("memory", memory.all, device.memory);
    expect("the largest piece of memory", memory.largest_field, device.largest_allocation);
}

}  // namespace

std::string memory_text(std::uint64_t bytes) {
    const auto size = static_cast<double>(bytes);
    return size < 1e9 ? fmt::format("{:.3g} MB", size / 1e6) : fmt::format("{:.3g} GB", size / 1e9);
}

FieldNeeds field_needs(const std::vector<Replica>& replicas) {
    FieldNeeds needs;
    for (const Replica& replica : replicas) {
        needs.displacements |= replica.contact.model != ContactModel::independent;
        needs.springs |= mindlin_share(replica) > 0;
        needs.deepest |= replica.effects.plasticity > 0;
        needs.cells |= is_cell(replica.box);
        needs.relaxed |= replica.effects.viscoelasticity > 0;
        needs.rolling |= replica.effects.rolling_resistance > 0;
    }
    return needs;
}

FieldExtents field_extents(const KernelBuild& build, const std::vector<Replica>& replicas,
                           const std::vector<PackingSize>& sizes, std::uint64_t cells) {
    FieldExtents extents;
    extents.replicas = replicas.size();
    for (const PackingSize& size : sizes) {
        extents.blocks += (size.grains + build.block() - 1) / build.block();
        extents.portions += portion_count(size.grains);
    }
    extents.grains = extents.blocks * build.block();
    extents.cells = cells;
    extents.slots = build.slots;
    extents.species = static_cast<std::uint64_t>(materials_kept(replicas));
    extents.precision = build.precision;
    extents.needs = field_needs(replicas);
    return extents;
}

namespace {

/// With the largest cell lists.
FieldExtents max_extents(const KernelBuild& build, const std::vector<Replica>& replicas,
                         const std::vector<PackingSize>& sizes) {
    std::uint64_t cells = 0;
    for (const PackingSize& size : sizes) cells += max_cells(size.grains);
    return field_extents(build, replicas, sizes, cells);
}

}  // namespace

FieldMemory memory_needed(Precision precision, int slots, const std::vector<Replica>& replicas,
                          const std::vector<PackingSize>& sizes) {
    return Fields::memory_of(max_extents({.precision = precision, .slots = slots}, replicas, sizes));
}

void expect_within_limits(const DeviceInfo& device, const KernelBuild& build,
                          const std::vector<Replica>& replicas, const std::vector<PackingSize>& sizes) {
    if (build.work_items() > device.largest_work_group)
        throw InputError(fmt::format("numerics.slots must be at most {} on {}, got {}",
                                     device.largest_work_group / 16 * 16, device.name, build.slots));
    const FieldExtents extents = max_extents(build, replicas, sizes);
    if (extents.grains * extents.slots >= max_int || extents.cells > max_int)
        throw InputError(fmt::format(
            "packing.count and batch.replicas must leave at most {} slots and {} cells in one go, got {} and "
            "{}: {}",
            max_int - 1, max_int, extents.grains * extents.slots, extents.cells,
            remedy(replicas.size(), 0.5)));
    expect_room(device, Fields::memory_of(extents), replicas.size());
}

namespace {

/// The fastest strain rate must change the shape of the cell only little per step.
void expect_slow_strains(const Replica& replica, double time_step) {
    constexpr double most = 0.01;  // strain per step
    for (std::size_t n = 0; is_cell(replica.box) && n < replica.programme.size(); ++n)
        if (const Stage& stage = replica.programme[n];
            stage.kind == StageKind::move && stage.rate * time_step > most)
            throw InputError(
                fmt::format("programme.{}.rate must leave strains of at most {} in a time step of {:.3g} "
                            "s, got {} 1/s: at most {:.3g} 1/s",
                            n + 1, most, time_step, stage.rate, most / time_step));
}

}  // namespace

void expect_countable_steps(const Replica& replica, double time_step) {
    const Protocol& protocol = replica.protocol;
    const auto stages = stages_of(replica);
    const double scans = scan_count(stages);
    const double seconds =
        protocol.relax_time +
        sum_over_legs(stages, [&](const Stage& stage) { return seconds_of_stage(stage, replica); }) +
        (protocol.stop_at_scans ? scans * std::max(protocol.settle_time, protocol.pause) : 0);
    if (!(time_step >= min_time_step))
        throw InputError(
            fmt::format("numerics.time_step must leave steps of at least {} s, got {} s: take larger, "
                        "heavier or softer grains",
                        min_time_step, time_step));
    expect_slow_strains(replica, time_step);
    const double steps = seconds / time_step + 2 * scans;
    if (!(steps <= max_steps))
        throw InputError(
            fmt::format("plate.speed, the times of [protocol] and those of a programme must leave at most {} "
                        "steps, got {:.3g} for "
                        "{:.3g} s in steps of {:.3g} s: a faster plate, a shorter stroke, or shorter times",
                        max_steps, steps, seconds, time_step));
}

void expect_slow_grains(const Replica& replica, const PackingSize& size, double time_step) {
    const double most = 0.5 * replica.numerics.skin * size.smallest / 2;
    if (size.fastest * time_step <= most) return;
    throw InputError(fmt::format(
        "packing.file: initial velocities, and spins times the radius, must be at most {:.6g} m/s, got "
        "{:.6g}: no grain may move by more than {:.3g} m, half of numerics.skin times the smallest radius, "
        "in a time step of {:.3g} s (lower numerics.time_step)",
        most / time_step, size.fastest, most, time_step));
}

void expect_runnable(const Device& device, const Scene& scene) {
    const auto sizes = packing_sizes(scene.replicas);
    expect_within_limits(device.info(), kernel_build(device, scene.precision, scene.slots), scene.replicas,
                         sizes);
    for (std::size_t r = 0; r < sizes.size(); ++r) {
        const double step = time_step(scene.replicas[r], sizes[r].smallest / 2);
        expect_countable_steps(scene.replicas[r], step);
        expect_slow_grains(scene.replicas[r], sizes[r], step);
    }
}

}  // namespace mcdem::sim
