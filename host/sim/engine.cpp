#include "sim/engine.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/container.h"
#include "core/errors.h"
#include "core/expects.h"
#include "core/stress.h"
#include "scene/packing/true_grains.h"
#include "sim/batch_limits.h"
#include "sim/device_material.h"
#include "sim/device_replica.h"
#include "sim/reports.h"

namespace mcdem::inline sim {
namespace {

/// A list is rebuilt when a grain or the plate has moved by this fraction of the margin. Half the margin is
/// the limit that the kernels check in every step.
constexpr double rebuild_at = 0.3;
/// Maximum displacement of the plate in an interval over the margin: rebuild_at + plate_share <= 1/2.
constexpr double plate_share = 0.2;
/// In a cell, by which two grains at the reach of the list are displaced relative to each other: the same
/// fractions of `cell_share` of the margin, twice. The grains' own motion may use the rest.
constexpr double margin_of_walls(const Replica& replica) { return is_cell(replica.box) ? 2 * cell_share : 1; }

template <class DeviceReplica>
std::vector<DeviceReplica> device_replicas(const std::vector<Replica>& replicas,
                                           const std::vector<Packing>& packings, const Layout& layout) {
    std::vector<DeviceReplica> all;
    int cells = 0;
    const MemoryRows rows = memory_rows(field_needs(replicas));
    for (int r = 0; r < layout.replicas(); ++r) {
        all.push_back(device_replica<DeviceReplica>(replicas[r], packings[r],
                                                    {layout.first_grain[r], layout.grain_count[r], cells}));
        all.back().memory_rows = rows.count;
        all.back().radius_row = rows.radius;
        all.back().deepest_row = rows.deepest;
        all.back().relaxed_row = rows.relaxed;
        all.back().rolling_row = rows.rolling;
        cells += cell_count(all.back());
    }
    return all;
}

int total_cells(const auto& device_replicas) {
    return device_replicas.back().first_cell + cell_count(device_replicas.back());
}

std::vector<PackingSize> sizes_of(const std::vector<Packing>& packings) {
    std::vector<PackingSize> sizes;
    for (const Packing& packing : packings) sizes.push_back(size_of(packing));
    return sizes;
}

std::variant<std::vector<f32::Replica>, std::vector<f64::Replica>> any_device_replicas(
    const KernelBuild& build, const std::vector<Replica>& replicas, const std::vector<Packing>& packings,
    const Layout& layout) {
    if (build.precision == Precision::double_precision)
        return device_replicas<f64::Replica>(replicas, packings, layout);
    return device_replicas<f32::Replica>(replicas, packings, layout);
}

KernelBuild with_species(KernelBuild build, const std::vector<Replica>& replicas) {
    build.species = materials_kept(replicas);
    return build;
}

}  // namespace

std::size_t enough_replicas(const DeviceInfo& device, const KernelBuild& build) {
    if (build.lanes == 1) return std::numeric_limits<std::size_t>::max();
    return 2 * device.compute_units;
}

Engine::Engine(Device& device, const KernelBuild& build, std::vector<Replica> replicas,
               std::vector<Packing> packings)
    : build_(with_species(build, replicas)),
      enough_replicas_(enough_replicas(device.info(), build)),
      replicas_(std::move(replicas)),
      layout_((expect_within_limits(device.info(), build_, replicas_, sizes_of(packings)),
               make_layout(packings, build_.block()))),
      device_replicas_(any_device_replicas(build_, replicas_, packings, layout_)),
      fields_(device,
              field_extents(build_, replicas_, sizes_of(packings),
                            std::visit([](const auto& all) { return total_cells(all); }, device_replicas_))),
      kernels_(device, build_) {
    expects(packings.size() == replicas_.size(), "each replica has a packing");
    std::visit(
        [&](auto& all) {
            for (std::size_t r = 0; r < all.size(); ++r) {
                all[r].slot_count = fields_.slot_count;
                all[r].batch_size = layout_.replicas();
                runs_.push_back({.time_step = mcdem::time_step(replicas_[r], packings[r]),
                                 .skin = all[r].skin,
                                 .reach = list_reach(replicas_[r], packings[r])});
            }
        },
        device_replicas_);
    upload_materials();
    upload_packings(packings);
    start_springs(packings);
}

void Engine::upload_materials() {
    if (build_.precision == Precision::double_precision)
        fields_.materials.write(device_materials<f64::Material>(replicas_, build_.species).data());
    else
        fields_.materials.write(device_materials<f32::Material>(replicas_, build_.species).data());
}

void Engine::upload_packings(const std::vector<Packing>& packings) {
    std::vector<double> values(reals_of_motion * layout_.grains(), 0.0);
    for (int r = 0; r < layout_.replicas(); ++r) {
        const auto excess = excess_compliance(replicas_[r], packings[r].size());
        for (int k = 0; k < layout_.grain_count[r]; ++k) {
            const int grain = layout_.order[r][k];
            double* at = &values[reals_of_motion * (layout_.first_grain[r] + k)];
            for (int axis = 0; axis < 3; ++axis) at[axis] = packings[r].position[grain][axis];
            for (int axis = 0; axis < 3 && !packings[r].velocity.empty(); ++axis)
                at[4 + axis] = packings[r].velocity[grain][axis];
            for (int axis = 0; axis < 3 && !packings[r].angular_velocity.empty(); ++axis)
                at[8 + axis] = packings[r].angular_velocity[grain][axis];
            at[3] = 0.5 * packings[r].diameter[grain];
            at[7] = excess[grain];
            at[11] = static_cast<double>(packings[r].species_of(grain));
        }
    }
    for (auto& copy : fields_.motion.copies) write_reals(copy, 0, values);
    std::vector<double> tracks(reals_of_track * layout_.grains(), 0.0);
    for (std::size_t real = 7; real < tracks.size(); real += reals_of_track)
        tracks[real] = 1;  // identity rotation
    write_reals(fields_.tracks, 0, tracks);
}

double Engine::time_step(int replica) const {
    const ReplicaRun& now = run(replica);
    return shortened(now.time_step, std::min(now.shortening + now.extra_shortening, max_shortening));
}

bool Engine::shorten(int replica) {
    ReplicaRun& now = run(replica);
    if (now.shortening + now.extra_shortening >= max_shortening) return false;
    now.extra_shortening += 4;
    return true;
}

/// Speed of the plate, or of a cell's motion between two grains at the reach of the list [m/s].
double Engine::speed_of_walls(int replica, const StepInterval& interval) const {
    if (!is_cell(replicas_[static_cast<std::size_t>(replica)].box)) return std::abs(interval.plate_velocity);
    return run(replica).reach * velocity_gradient(interval.strain, interval.strain_rate).norm();
}

int Engine::max_interval(int replica, const StepInterval& interval) const {
    const double step = speed_of_walls(replica, interval) * time_step(replica, interval);
    const double steps = step > 0 ? max_plate_move(replica) / step : max_interval_steps;
    return std::clamp(static_cast<int>(std::min(steps, 1e6)), 1, max_interval_steps);
}

double Engine::max_plate_move(int replica) const {
    return plate_share * margin_of_walls(replicas_[static_cast<std::size_t>(replica)]) * run(replica).skin;
}

template <class Wanted>
Engine::Selection Engine::select(Wanted wanted) const {
    Selection some;
    for (int r = 0; r < layout_.replicas(); ++r) {
        if (!wanted(run(r))) continue;
        some.replicas.push_back(r);
        std::ranges::copy(layout_.blocks(r), std::back_inserter(some.blocks));
        std::ranges::copy(layout_.portions(r), std::back_inserter(some.portions));
    }
    return some;
}

/// Uploads the lists of replicas that make steps, if they have changed. Returns false if there are none.
bool Engine::activate_moving() {
    bool changed = false, any = false;
    for (int r = 0; r < layout_.replicas(); ++r) {
        const bool active = intervals_[static_cast<std::size_t>(r)].steps > 0;
        any |= active;
        changed |= std::exchange(run(r).active, active) != active;
    }
    if (!changed || !any) return any;
    working_ = select([](const ReplicaRun& one) { return one.active; });
    std::vector<Block> first_blocks;
    for (const int r : working_.replicas) first_blocks.push_back({r, layout_.first_grain[r]});
    fields_.first_blocks.write(first_blocks.data(), 0, first_blocks.size() * sizeof(Block));
    fields_.blocks.write(working_.blocks.data(), 0, working_.blocks.size() * sizeof(Block));
    fields_.portions.write(working_.portions.data(), 0, working_.portions.size() * sizeof(Portion));
    return true;
}

void Engine::begin_interval(const std::vector<StepInterval>& intervals) {
    expects(intervals.size() == replicas_.size(), "each replica has an interval");
    for (const StepInterval& next : intervals)
        expects(next.steps >= 0 && next.step_part > 0 && next.step_part <= 1,
                "an interval has whole steps, not longer than the time step");
    intervals_ = intervals;
    if (!activate_moving()) return;
    upload_intervals();
    find_neighbours();
    make_steps();
    measure();
    fields_.reports.flush();
}

void Engine::upload_intervals() {
    std::vector<int> steps;
    for (const auto& interval : intervals_) steps.push_back(interval.steps);
    steps.push_back(0);  // no replica is taken yet
    fields_.stop_at.write(steps.data());
    std::visit(
        [&](auto& all) {
            for (std::size_t r = 0; r < all.size(); ++r) {
                const StepInterval& next = intervals_[r];
                if (next.steps == 0) continue;
                set_time_step(all[r], replicas_[r], time_step(static_cast<int>(r), next));
                if (is_cell(replicas_[r].box)) {
                    set_strain(all[r], replicas_[r], next.strain, next.strain_rate,
                               runs_[r].rebuild ? runs_[r].reach : 0);
                } else {
                    all[r].wall_position[5] = next.plate_z;
                    all[r].plate_velocity = next.plate_velocity;
                }
                all[r].steps_before = static_cast<int>(runs_[r].steps_made % 4);
                all[r].drag = replicas_[r].grains.drag + next.settle_drag;
                all[r].spin_drag = next.settle_drag;
            }
            fields_.replicas.write(all.data());
        },
        device_replicas_);
}

void Engine::find_neighbours() {
    const Selection stale = select([](const ReplicaRun& one) { return one.active && one.rebuild; });
    if (stale.replicas.empty()) return;
    const int blocks = static_cast<int>(stale.blocks.size());
    const auto groups = [&](int items,
                            int grains) {  // work-groups whose work-items have so many grains
        return (stale.blocks.size() * build_.block() + items * grains - 1) / (items * grains);
    };
    const std::size_t by_grain = groups(build_.list_items(), 1);
    auto& f = fields_;
    f.rebuilt.write(stale.portions.data(), 0, stale.portions.size() * sizeof(Portion));
    f.rebuilt_blocks.write(stale.blocks.data(), 0, stale.blocks.size() * sizeof(Block));
    kernels_.empty_cells(stale.portions.size(), f.replicas, f.rebuilt, f.cell_head);
    kernels_.fill_cells(by_grain, blocks, f.replicas, f.rebuilt_blocks, f.motion.now(0), f.cell_head,
                        f.cell_next);
    kernels_.list_neighbours(groups(build_.search_items(), build_.lanes), blocks, f.replicas,
                             f.rebuilt_blocks, f.motion.now(0), f.cell_head, f.cell_next, f.partner,
                             f.displacement.now(0), f.displacement_history, f.memory_of_contacts, f.tracks,
                             f.status);
    if (f.has_displacements())
        kernels_.link_partner_slots(by_grain, blocks, f.slot_count, f.rebuilt_blocks, f.partner,
                                    f.partner_slot);
    for (const int r : stale.replicas) {
        run(r).rebuild = 0;
        run(r).plate_moved = run(r).weight_work = 0;
    }
}

/// Enqueues the steps of the interval: in one launch if there is enough work for each core, otherwise in one
/// launch per step, in which replicas that have made their steps are skipped. Every double-buffered field
/// ends in its original buffer: a single launch leaves the last state in both, and launches per step are of
/// an even number.
void Engine::make_steps() {
    auto& f = fields_;
    const auto advance = [&](std::size_t groups, int step, int replicas, auto& blocks) {
        const int p = step % 2;
        kernels_.advance(groups, step, replicas, f.replicas, f.materials, blocks, f.stop_at, f.motion.now(p),
                         f.motion.next(p), f.partner, f.partner_slot, f.displacement.now(p),
                         f.displacement.next(p), f.displacement_history, f.memory_of_contacts, f.tracks,
                         f.status);
    };
    int steps = 0, largest = 1;
    for (const int r : working_.replicas) {
        steps = std::max(steps, intervals_[r].steps);
        largest = std::max(largest, layout_.block_count(r));
    }
    const std::size_t blocks = working_.blocks.size();
    if (blocks / largest >= enough_replicas_)
        return advance(enough_replicas_, 0, static_cast<int>(working_.replicas.size()), f.first_blocks);
    for (int step = 0; step < steps + steps % 2; ++step) advance(blocks, step, 0, f.blocks);
}

void Engine::measure() {
    auto& f = fields_;
    kernels_.measure(working_.blocks.size(), f.replicas, f.materials, f.blocks, f.stop_at, f.motion.now(0),
                     f.partner, f.partner_slot, f.displacement.now(0), f.memory_of_contacts, f.tracks,
                     f.force, f.overlap, f.arm, f.energy);
    kernels_.reduce(working_.portions.size(), f.replicas, f.portions, f.partner, f.force, f.energy, f.tracks,
                    f.status, f.reports);
    if (f.has_cells())
        kernels_.cell_stress(working_.portions.size(), f.replicas, f.portions, f.stop_at, f.motion.now(0),
                             f.partner, f.force, f.cell_moments);
}

/// Stresses of active replicas that are cells, at their strains.
std::vector<Mat3> Engine::read_stresses() const {
    std::vector<Mat3> stress(replicas_.size(), Mat3::Zero());
    if (!fields_.has_cells()) return stress;
    const auto moments = read_reals(fields_.cell_moments, 0, 9 * working_.portions.size());
    for (std::size_t p = 0; p < working_.portions.size(); ++p)
        for (int q = 0; q < 9; ++q)
            stress[static_cast<std::size_t>(working_.portions[p].replica)](q / 3, q % 3) +=
                moments[9 * p + q];
    for (const int replica : working_.replicas) {
        const auto r = static_cast<std::size_t>(replica);
        const Box now = deformed(replicas_[r].box, runs_[r].strain);
        stress[r] /= floor_area(now) * now.height;
    }
    return stress;
}

std::vector<IntervalResult> Engine::finish_interval() {
    std::vector<IntervalResult> results(replicas_.size());
    if (std::ranges::all_of(intervals_, [](const auto& interval) { return interval.steps == 0; }))
        return results;
    std::vector<int> made(replicas_.size() + 1);
    fields_.stop_at.read(made.data());
    std::visit(
        [&]<class DeviceReplica>(const std::vector<DeviceReplica>&) {
            using Report =
                std::conditional_t<std::is_same_v<DeviceReplica, f64::Replica>, f64::Report, f32::Report>;
            std::vector<Report> found(working_.portions.size());
            fields_.reports.read(found.data(), 0, found.size() * sizeof(Report));
            const auto reports = by_replica(working_.portions, found, layout_.replicas());
            for (const int replica : working_.replicas) {
                const auto r = static_cast<std::size_t>(replica);
                results[r] = to_result(reports[r]);
                results[r].steps = made[r];
                record(replica, results[r], reports[r].moved_squared);
            }
        },
        device_replicas_);
    const auto stresses = read_stresses();
    for (const int replica : working_.replicas) {
        const auto r = static_cast<std::size_t>(replica);
        if (!is_cell(replicas_[r].box)) continue;
        results[r].stress = stresses[r];
        results[r].wall_force = face_forces(deformed(replicas_[r].box, runs_[r].strain), stresses[r]);
    }
    return results;
}

/// Notes where the interval has ended, whether the neighbour list is still valid, and the next time step.
void Engine::record(int replica, IntervalResult& result, double moved_squared) {
    ReplicaRun& now = run(replica);
    const Replica& scene = replicas_[static_cast<std::size_t>(replica)];
    const StepInterval& interval = intervals_[static_cast<std::size_t>(replica)];
    const double step = time_step(replica, interval), duration = step * result.steps;
    for (std::size_t k = 0; k < now.strain.size(); ++k)
        now.strain[k] = interval.strain[k] + duration * interval.strain_rate[k];
    result.weight_work -= std::exchange(now.weight_work, result.weight_work);
    if (result.failed_grain >= 0)
        result.failed_grain = layout_.order[replica][result.failed_grain - layout_.first_grain[replica]];
    now.plate_moved += speed_of_walls(replica, interval) * step * result.steps;
    now.plate_z = interval.plate_z + interval.plate_velocity * step * result.steps;
    now.steps_made += result.steps;
    const double limit = rebuild_at * now.skin;
    const double own_limit = is_cell(scene.box) ? (1 - cell_share) * limit : limit;
    now.rebuild = result.steps < interval.steps || now.plate_moved > margin_of_walls(scene) * limit ||
                  !(moved_squared <= own_limit * own_limit);
    if (!now.keeps_step) now.shortening = shortening(now.time_step, result.step_rate, now.shortening);
}

}  // namespace mcdem::sim
