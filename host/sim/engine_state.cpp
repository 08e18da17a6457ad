// Reading and writing the state of replicas between intervals, and checkpoints.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>

#include "core/container.h"
#include "core/errors.h"
#include "core/expects.h"
#include "core/in_parallel.h"
#include "scene/plate_face.h"
#include "sim/batch_limits.h"
#include "sim/device_replica.h"
#include "sim/engine.h"

namespace mcdem::inline sim {
namespace {

/// A vector of each grain's motion that begins at real number `first`.
std::vector<Vec3> by_grain(const std::vector<double>& motion, std::size_t first,
                           const std::vector<int>& order) {
    std::vector<Vec3> vectors(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        const double* at = &motion[reals_of_motion * k + first];
        vectors[order[k]] = {at[0], at[1], at[2]};
    }
    return vectors;
}

/// Rotations from their quaternions.
std::vector<Vec3> rotations(const std::vector<double>& tracks, const std::vector<int>& order) {
    std::vector<Vec3> vectors(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        const Eigen::AngleAxisd turn{Eigen::Quaterniond{&tracks[reals_of_track * k + 4]}};
        vectors[order[k]] = turn.angle() * turn.axis();
    }
    return vectors;
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

Readings Engine::begin_reading(int first_replica, int last_replica) const {
    const auto first = static_cast<std::size_t>(layout_.first_grain[first_replica]);
    const auto grains = static_cast<std::size_t>(layout_.first_grain[last_replica + 1]) - first;
    const auto slots = static_cast<std::size_t>(build_.slots), real = size_of_real();
    Readings read;
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
    return read;
}

std::vector<Readings> Engine::begin_reading(const std::vector<int>& replicas) const {
    expects(std::ranges::is_sorted(replicas), "replicas are read in ascending order");
    std::vector<Readings> read;
    for (std::size_t begin = 0, end; begin < replicas.size(); begin = end) {
        end = begin + 1;
        while (end < replicas.size() && replicas[end] == replicas[end - 1] + 1) ++end;
        read.push_back(begin_reading(replicas[begin], replicas[end - 1]));
    }
    return read;
}

void Engine::for_each_state(const std::vector<Readings>& read,
                            const std::function<void(std::size_t, ReplicaState)>& use) const {
    std::vector<std::pair<int, const Readings*>> states;
    for (const Readings& some : read) {
        some.copies.wait();
        for (int r = some.first_replica; r <= some.last_replica; ++r) states.emplace_back(r, &some);
    }
    in_parallel(states.size(), [&](std::size_t i) { use(i, state(states[i].first, *states[i].second)); });
}

ReplicaState Engine::state(int replica) const {
    const Readings read = begin_reading(replica, replica);
    read.copies.wait();
    return state(replica, read);
}

ReplicaState Engine::state(int replica, const Readings& read) const {
    const auto& order = layout_.order[replica];
    const auto first = static_cast<std::size_t>(layout_.first_grain[replica]) - read.first_grain;
    const auto motion = reals(read.motion, reals_of_motion * first, reals_of_motion * order.size());
    ReplicaState state;
    state.position = by_grain(motion, 0, order);
    if (is_cell(replicas_[replica].box))
        for (Vec3& x : state.position) x = deformation(run(replica).strain) * x;
    state.velocity = by_grain(motion, 4, order);
    state.angular_velocity = by_grain(motion, 8, order);
    state.rotation =
        rotations(reals(read.tracks, reals_of_track * first, reals_of_track * order.size()), order);
    state.contacts = contacts(replica, state.position, read);
    return state;
}

/// Unit vector from the centre of a grain to its partner, a number as in the field Partner.
Vec3 Engine::direction(int replica, const std::vector<Vec3>& position, int grain, int partner) const {
    const Box box = deformed(true_box(replicas_[replica]), run(replica).strain);
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

std::vector<Contact> Engine::contacts(int replica, const std::vector<Vec3>& position,
                                      const Readings& read) const {
    const auto& order = layout_.order[replica];
    const auto slots = static_cast<std::size_t>(build_.slots);
    const auto padded =
        static_cast<std::size_t>(layout_.first_grain[replica + 1] - layout_.first_grain[replica]);
    const std::size_t first =
        (static_cast<std::size_t>(layout_.first_grain[replica]) - read.first_grain) * slots;
    const std::size_t count = padded * slots;
    const auto force = reals(read.force, 3 * first, 3 * count), overlap = reals(read.overlap, first, count),
               arm = reals(read.arm, first, count);
    const std::size_t row = build_.lanes * slots;  // length of a row of forces, see kernels/measure.cl
    const int* const partner = reinterpret_cast<const int*>(read.partner.data()) + first;
    const PlateFace plate = plate_face(replicas_[replica], run(replica).plate_z);
    std::vector<Contact> found;
    for (std::size_t slot = 0; slot < count; ++slot) {
        if (!(overlap[slot] > 0)) continue;
        Contact contact;
        contact.grain = order[build_.grain_of_slot(slot)];
        if (partner[slot] < NO_PARTNER) {
            contact.partner = wall_partner(static_cast<Wall>(WALL_PARTNER(0) - partner[slot]));
        } else {
            contact.partner = order[partner[slot] - layout_.first_grain[replica]];
            if (contact.partner < contact.grain) continue;  // listed by the other grain
        }
        contact.point =
            position[contact.grain] + arm[slot] * direction(replica, position, contact.grain, partner[slot]);
        if (contact.partner == wall_partner(Wall::plate)) contact.point = plate.foot(position[contact.grain]);
        const double* const along_x = &force[slot / row * 3 * row + slot % row];
        contact.force = {along_x[0], along_x[row], along_x[2 * row]};
        contact.overlap = overlap[slot];
        found.push_back(contact);
    }
    std::sort(found.begin(), found.end(), [](const Contact& a, const Contact& b) {
        return a.grain != b.grain ? a.grain < b.grain : a.partner < b.partner;
    });
    return found;
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
