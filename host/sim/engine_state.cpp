// Reading and writing the state of replicas between intervals, and checkpoints.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstring>

#include "core/container.h"
#include "core/errors.h"
#include "core/expects.h"
#include "core/in_parallel.h"
#include "scene/packing/neighbour_slots.h"
#include "scene/plate_face.h"
#include "sim/batch_limits.h"
#include "sim/device_replica.h"
#include "sim/engine.h"

namespace mcdem::inline sim {
namespace {

/// Vectors of the grains from the rows of a field, each with `width` numbers; `vector_at` takes a row.
template <class Real, class VectorAt>
void by_grain(const Real* rows, std::size_t width, const std::vector<int>& order, std::vector<Vec3>& vectors,
              VectorAt vector_at) {
    vectors.resize(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) vectors[order[k]] = vector_at(rows + width * k);
}

template <class Real>
Vec3 first_three(const Real* row) {
    return {row[0], row[1], row[2]};
}

/// Rotation from its quaternion.
template <class Real>
Vec3 rotation(const Real* track) {
    const Eigen::AngleAxisd turn{Eigen::Quaterniond(track[7], track[4], track[5], track[6])};
    return turn.angle() * turn.axis();
}

template <class Real>
const Real* numbers(const std::vector<std::byte>& bytes, std::size_t first) {
    return reinterpret_cast<const Real*>(bytes.data()) + first;
}

int number_at(const std::byte* bytes, std::size_t index) {
    int number = 0;
    std::memcpy(&number, bytes + index * sizeof number, sizeof number);
    return number;
}

[[noreturn]] void refuse(const char* name, std::size_t slot, int number) {
    refuse_checkpoint(fmt::format("slot {} of '{}' holds the invalid number {}", slot, name, number));
}

/// Checks partners and partner slots, because kernels use them as indices without checks.
void expect_partners(const Layout& layout, int slots, const std::byte* partner) {
    for (int r = 0; r < layout.replicas(); ++r) {
        const int first = layout.first_grain[r], last = first + layout.grain_count[r];
        const auto from = std::size_t(first) * slots, to = std::size_t(layout.first_grain[r + 1]) * slots;
        for (std::size_t slot = from; slot < to; ++slot) {
            const int other = number_at(partner, slot);
            if (other < WALL_PARTNER(wall_count - 1) || (other >= 0 && (other < first || other >= last)))
                refuse("partner", slot, other);
        }
    }
}

void expect_partner_slots(int slot_count, const std::byte* partner_slot, std::size_t bytes) {
    for (std::size_t slot = 0; slot < bytes / sizeof(int); ++slot)
        if (const int place = number_at(partner_slot, slot); place < 0 || place > slot_count)
            refuse("partner_slot", slot, place);
}

}  // namespace

void refuse_checkpoint(const std::string& what) {
    throw InputError("the checkpoint is damaged: " + what + ": start the run again in another folder");
}

std::vector<double> Engine::reals(const std::vector<std::byte>& bytes, std::size_t first,
                                  std::size_t count) const {
    std::vector<double> values(count);
    if (size_of_real() == sizeof(double)) {
        std::memcpy(values.data(), bytes.data() + first * sizeof(double), count * sizeof(double));
    } else {
        std::vector<float> floats(count);
        std::memcpy(floats.data(), bytes.data() + first * sizeof(float), count * sizeof(float));
        values.assign(floats.begin(), floats.end());
    }
    return values;
}

template <class Quantity>
std::vector<double> Engine::read_reals(const Field<Quantity>& field, std::size_t first,
                                       std::size_t count) const {
    const std::size_t size = size_of_real();
    std::vector<std::byte> bytes(count * size);
    field.read(bytes.data(), first * size, bytes.size());
    return reals(bytes, 0, count);
}

template <class Quantity>
void Engine::write_reals(Field<Quantity>& field, std::size_t first, const std::vector<double>& values) {
    if (build_.precision == Precision::double_precision) {
        field.write(values.data(), first * sizeof(double), values.size() * sizeof(double));
    } else {
        const std::vector<float> reals(values.begin(), values.end());
        field.write(reals.data(), first * sizeof(float), reals.size() * sizeof(float));
    }
}

template std::vector<double> Engine::read_reals(const Field<CellMoments>&, std::size_t, std::size_t) const;
template void Engine::write_reals(Field<Motion>&, std::size_t, const std::vector<double>&);
template void Engine::write_reals(Field<Tracks>&, std::size_t, const std::vector<double>&);
template void Engine::write_reals(Field<ContactMemory>&, std::size_t, const std::vector<double>&);

void Engine::begin_reading(int first_replica, int last_replica, Readings& read) const {
    const auto first = static_cast<std::size_t>(layout_.first_grain[first_replica]);
    const auto grains = static_cast<std::size_t>(layout_.first_grain[last_replica + 1]) - first;
    const auto slots = static_cast<std::size_t>(build_.slots), real = size_of_real();
    read.first_replica = first_replica;
    read.last_replica = last_replica;
    read.first_grain = first;
    const auto begin = [&](const auto& field, std::vector<std::byte>& to, std::size_t bytes_of_grain) {
        to.resize(grains * bytes_of_grain);
        field.begin_read(to.data(), first * bytes_of_grain, to.size(), read.copies);
    };
    begin(fields_.motion.copies[0], read.motion, reals_of_motion * real);
    begin(fields_.tracks, read.tracks, reals_of_track * real);
    begin(fields_.force, read.force, 3 * slots * real);
    begin(fields_.overlap, read.overlap, slots * real);
    begin(fields_.arm, read.arm, slots * real);
    begin(fields_.partner, read.partner, slots * sizeof(int));
}

std::size_t Engine::begin_reading(const std::vector<int>& replicas, std::vector<Readings>& read) const {
    expects(std::ranges::is_sorted(replicas), "replicas are read in ascending order");
    std::size_t count = 0;
    for (std::size_t begin = 0, end; begin < replicas.size(); begin = end) {
        end = begin + 1;
        while (end < replicas.size() && replicas[end] == replicas[end - 1] + 1) ++end;
        if (count == read.size()) read.emplace_back();
        begin_reading(replicas[begin], replicas[end - 1], read[count++]);
    }
    return count;
}

void Engine::for_each_state(std::span<const Readings> read,
                            const std::function<void(std::size_t, int replica, const Readings&)>& use) const {
    std::vector<std::pair<int, const Readings*>> states;
    for (const Readings& some : read) {
        some.copies.wait();
        for (int r = some.first_replica; r <= some.last_replica; ++r) states.emplace_back(r, &some);
    }
    in_parallel(states.size(), [&](std::size_t i) { use(i, states[i].first, *states[i].second); });
}

ReplicaState Engine::state(int replica) const {
    Readings read;
    begin_reading(replica, replica, read);
    read.copies.wait();
    Scan scan;
    take_state(replica, read, scan);
    ReplicaState state{std::move(scan.position), {}, {}, std::move(scan.rotation), std::move(scan.contacts)};
    const auto motion = reals(read.motion, 0, reals_of_motion * layout_.order[replica].size());
    by_grain(&motion[4], reals_of_motion, layout_.order[replica], state.velocity, first_three<double>);
    by_grain(&motion[8], reals_of_motion, layout_.order[replica], state.angular_velocity,
             first_three<double>);
    return state;
}

void Engine::take_state(int replica, const Readings& read, Scan& scan) const {
    if (build_.precision == Precision::double_precision)
        take_state_of<double>(replica, read, scan);
    else
        take_state_of<float>(replica, read, scan);
}

template <class Real>
void Engine::take_state_of(int replica, const Readings& read, Scan& scan) const {
    const auto& order = layout_.order[replica];
    const auto first = static_cast<std::size_t>(layout_.first_grain[replica]) - read.first_grain;
    by_grain(numbers<Real>(read.motion, reals_of_motion * first), reals_of_motion, order, scan.position,
             first_three<Real>);
    if (is_cell(replicas_[replica].box))
        for (Vec3& x : scan.position) x = deformation(run(replica).strain) * x;
    by_grain(numbers<Real>(read.tracks, reals_of_track * first), reals_of_track, order, scan.rotation,
             rotation<Real>);
    take_contacts<Real>(replica, read, scan);
}

/// Unit vector from the centre of a grain to its partner, a number as in the field Partner, in the deformed
/// box.
Vec3 Engine::direction(int replica, const Box& box, const std::vector<Vec3>& position, int grain,
                       int partner) const {
    if (partner >= 0) {
        const int other = layout_.order[replica][partner - layout_.first_grain[replica]];
        return apart(box, position[grain], position[other]).normalized();
    }
    const int wall = WALL_PARTNER(0) - partner;
    if (static_cast<Wall>(wall) == Wall::plate)
        return plate_face(replicas_[replica], run(replica).plate_z).normal();
    if (is_cylinder(box) && static_cast<Wall>(wall) == curved_wall)
        return from_axis(box, position[grain]).normalized();
    return (wall % 2 ? 1 : -1) * Vec3::Unit(wall / 2);
}

/// In ascending order of grains and partners.
template <class Real>
void Engine::take_contacts(int replica, const Readings& read, Scan& scan) const {
    const auto& order = layout_.order[replica];
    const auto& place = layout_.place[replica];
    const auto slots = static_cast<std::size_t>(build_.slots), lanes = static_cast<std::size_t>(build_.lanes),
               row = lanes * slots;
    const int first_grain = layout_.first_grain[replica];
    const auto first = (static_cast<std::size_t>(first_grain) - read.first_grain) * slots;
    const Real *const force = numbers<Real>(read.force, 3 * first),
                      *const overlap = numbers<Real>(read.overlap, first),
                      *const arm = numbers<Real>(read.arm, first);
    const int* const partners = numbers<int>(read.partner, first);
    const PlateFace plate = plate_face(replicas_[replica], run(replica).plate_z);
    const Box box = deformed(true_box(replicas_[replica]), run(replica).strain);
    std::array<std::pair<int, std::size_t>, most_slots> touching;  // partner and its slot
    scan.contacts.clear();
    for (int grain = 0; grain < static_cast<int>(order.size()); ++grain) {
        auto end = touching.begin();
        const auto at = build_.place_of_slot(static_cast<std::size_t>(place[grain]), 0), lane = at % lanes;
        for (std::size_t slot = at; slot < at + row; slot += lanes) {
            if (!(overlap[slot] > 0)) continue;
            const int partner = partners[slot] < NO_PARTNER
                                    ? wall_partner(static_cast<Wall>(WALL_PARTNER(0) - partners[slot]))
                                    : order[partners[slot] - first_grain];
            if (is_wall(partner) || partner > grain) *end++ = {partner, slot};  // or the other grain lists it
        }
        const Real* const forces = force + 2 * (at - lane);  // of three rows, see kernels/measure.cl
        std::sort(touching.begin(), end);
        for (auto next = touching.begin(); next != end; ++next) {
            const auto [partner, slot] = *next;
            const Real* const along_x = forces + slot;
            const Vec3& centre = scan.position[grain];
            const Vec3 point = partner == wall_partner(Wall::plate)
                                   ? plate.foot(centre)
                                   : Vec3(centre + arm[slot] * direction(replica, box, scan.position, grain,
                                                                         partners[slot]));
            scan.contacts.push_back(
                {grain, partner, point, {along_x[0], along_x[row], along_x[2 * row]}, overlap[slot]});
        }
    }
}

void Engine::set_velocities(int replica, const std::vector<Vec3>& velocity,
                            const std::vector<Vec3>& angular_velocity) {
    write_motion(replica, {{}, velocity, angular_velocity});
}

/// Without positions the grains stay where they are.
void Engine::write_motion(int replica, const GrainMotion& motion) {
    const auto& order = layout_.order[replica];
    const std::size_t first = reals_of_motion * std::size_t(layout_.first_grain[replica]);
    auto values = read_reals(fields_.motion.copies[0], first, reals_of_motion * order.size());
    const auto put = [&](const std::vector<Vec3>& vectors, std::size_t place) {
        for (std::size_t k = 0; k < order.size() && !vectors.empty(); ++k)
            for (int axis = 0; axis < 3; ++axis)
                values[reals_of_motion * k + place + axis] = vectors[order[k]][axis];
    };
    put(motion.position, 0), put(motion.velocity, 4), put(motion.angular_velocity, 8);
    write_reals(fields_.motion.copies[0], first, values);
}

/// Starts the friction springs of loaded packings with the tangential forces of their past. Surfaces settle
/// first, in steps so short that no grain moves: without their displacements contacts are weaker, or open,
/// and Coulomb's limit would cut the springs.
void Engine::start_springs(const std::vector<Packing>& packings) {
    constexpr int settling = 3;
    constexpr double no_motion = 1e-6;
    std::vector<StepInterval> rest(replicas_.size());
    for (std::size_t r = 0; r < rest.size(); ++r)
        if (mindlin_share(replicas_[r]) > 0 && !packings[r].tangential.empty())
            rest[r] = in_part({max_interval_steps, replicas_[r].plate.start}, no_motion);
    const auto moves = [](const StepInterval& interval) { return interval.steps > 0; };
    if (std::ranges::none_of(rest, moves)) return;
    for (int interval = 0; interval < settling; ++interval) advance(rest);
    for (int r = 0; r < layout_.replicas(); ++r)
        if (moves(rest[r])) write_springs(r, packings[r].tangential);
}

void Engine::write_springs(int replica, const std::vector<TangentialForce>& tangential) {
    std::map<std::pair<int, int>, Vec3> springs;  // on the first grain, by partner
    for (const auto& [grain, partner, force] : tangential) {
        springs[{grain, partner}] = force / mindlin_share(replicas_[replica]);
        if (!is_wall(partner)) springs[{partner, grain}] = -springs[{grain, partner}];
    }
    const auto& order = layout_.order[replica];
    const int first = layout_.first_grain[replica];
    const auto slots = static_cast<std::size_t>(build_.slots),
               padded = static_cast<std::size_t>(layout_.first_grain[replica + 1] - first);
    const int rows = memory_rows(field_needs(replicas_)).count;
    std::vector<int> partners(padded * slots);
    fields_.partner.read(partners.data(), first * slots * sizeof(int), partners.size() * sizeof(int));
    auto memory = read_reals(fields_.memory_of_contacts, first * slots * rows, padded * slots * rows);
    for (std::size_t k = 0; k < order.size(); ++k)
        for (std::size_t slot = 0; slot < slots; ++slot) {
            const int device = partners[build_.place_of_slot(k, slot)];
            if (device == NO_PARTNER) continue;
            const int partner = device < 0 ? wall_partner(static_cast<Wall>(WALL_PARTNER(0) - device))
                                           : order[device - first];
            const auto spring = springs.find({order[k], partner});
            for (int axis = 0; axis < 3 && spring != springs.end(); ++axis)
                memory[build_.place_of_slot(k, slot, axis, rows)] = spring->second[axis];
        }
    write_reals(fields_.memory_of_contacts, first * slots * rows, memory);
}

std::map<std::string, std::vector<std::byte>> Engine::save() {
    std::map<std::string, std::vector<std::byte>> saved;
    fields_.visit_state([&](const char* name, auto& field) {
        auto& bytes = saved[name];
        bytes.resize(field.bytes());
        field.read(bytes.data());
    });
    ReplicaRun::visit_saved([&](const char* name, auto member) {
        for (const ReplicaRun& one : runs_) {
            const auto* begin = reinterpret_cast<const std::byte*>(&(one.*member));
            saved[name].insert(saved[name].end(), begin, begin + sizeof(one.*member));
        }
    });
    return saved;
}

void Engine::restore(const std::map<std::string, std::vector<std::byte>>& saved) {
    const auto bytes_of = [&](const char* name, std::size_t size) -> const std::byte* {
        const auto found = saved.find(name);
        if (found == saved.end() || found->second.size() != size)
            throw RunError(
                fmt::format("the checkpoint does not belong to this scene: '{}' must have {} "
                            "bytes, has {}",
                            name, size, found == saved.end() ? 0 : found->second.size()));
        return found->second.data();
    };
    expect_partners(layout_, build_.slots, bytes_of("partner", fields_.partner.bytes()));
    if (fields_.has_displacements())
        expect_partner_slots(fields_.slot_count, bytes_of("partner_slot", fields_.partner_slot.bytes()),
                             fields_.partner_slot.bytes());
    fields_.visit_state([&](const char* name, auto& field) { field.write(bytes_of(name, field.bytes())); });
    ReplicaRun::visit_saved([&](const char* name, auto member) {
        const std::size_t size = sizeof(runs_.front().*member);
        const std::byte* next = bytes_of(name, runs_.size() * size);
        for (ReplicaRun& one : runs_) {
            std::memcpy(&(one.*member), next, size);
            next += size;
        }
    });
    const auto possible = [](int times) { return times >= 0 && times <= max_shortening + 4; };
    for (const ReplicaRun& one : runs_) {
        if (one.steps_made < 0) refuse_checkpoint("it holds a negative number of steps");
        if (!possible(one.shortening) || !possible(one.extra_shortening))
            refuse_checkpoint("it holds an invalid time step");
    }
}

}  // namespace mcdem::sim
