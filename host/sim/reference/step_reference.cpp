#include "sim/reference/step_reference.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/recording.h"
#include "scene/packing/true_grains.h"
#include "sim/reference/grain_reference.h"

namespace mcdem::reference {
namespace {

using std::numbers::pi;

/// The periodic image of `point` that is closest to `to`.
Vec3 nearest_image(const mcdem::Box& box, const Vec3& point, const Vec3& to) {
    if (box.shape != mcdem::ContainerShape::periodic) return point;
    Vec3 nearest = point;
    for (int i = -5; i <= 5; ++i)
        for (int j = -5; j <= 5; ++j) {
            const Vec3 image = point + Vec3(i * box.size_x, j * box.size_y, 0);
            if ((image - to).norm() < (nearest - to).norm()) nearest = image;
        }
    return nearest;
}

bool is_there(const mcdem::Box& box, int partner) {
    if (!mcdem::is_wall(partner)) return true;
    const auto wall = mcdem::wall_of(partner);
    if (wall == mcdem::Wall::floor || wall == mcdem::Wall::plate) return true;
    if (box.shape == mcdem::ContainerShape::cylinder) return wall == mcdem::Wall::x_min;
    return box.shape == mcdem::ContainerShape::box;
}

}  // namespace

StepReference::StepReference(const mcdem::Replica& scene, const mcdem::Packing& packing)
    : position(packing.position),
      velocity(packing.size(), Vec3::Zero()),
      angular_velocity(packing.size(), Vec3::Zero()),
      memory(packing.size()),
      scene_(scene),
      species_(packing.species.empty() ? std::vector<int>(packing.size(), 0) : packing.species) {
    for (double diameter : packing.diameter) radius_.push_back(diameter / 2);
    for (int species : species_) {
        material_.push_back(scene.species.empty() ? scene.grains : scene.species[species].material);
        law_.push_back(mcdem::surface_law(scene.contact.model, material_.back().poisson_ratio,
                                          scene.contact.gamma, scene.effects.finite_strain));
    }
    const auto excess_compliance = mcdem::excess_compliance(scene, packing.size());
    std::vector<double> rayleigh_time;
    for (std::size_t i = 0; i < radius_.size(); ++i) {
        const auto& g = material_[i];
        youngs_modulus_.push_back(g.youngs_modulus / (1 + excess_compliance[i]));
        const double rayleigh_speed = 0.163 * g.poisson_ratio + 0.8766;  // divided by sqrt(G / rho)
        rayleigh_time.push_back(pi * radius_[i] *
                                std::sqrt(g.density / shear_modulus(youngs_modulus_[i], g.poisson_ratio)) /
                                rayleigh_speed);
    }
    time_step_ = scene.numerics.time_step * *std::min_element(rayleigh_time.begin(), rayleigh_time.end());
    const double mean = std::accumulate(radius_.begin(), radius_.end(), 0.0) / radius_.size();
    probe_gap_ = scene.numerics.probe_gap * mean;
    reach_ = (scene.numerics.probe_gap + scene.numerics.skin) * mean;
    begin(scene.plate.start);
}

double StepReference::mass(int grain) const {
    return material_[grain].density * 4 / 3 * pi * std::pow(radius_[grain], 3);
}

void StepReference::begin(double plate_z, double plate_velocity, double settle_drag) {
    plate_z_ = plate_z;
    plate_velocity_ = plate_velocity;
    drag_ = scene_.grains.drag + settle_drag;
    spin_drag_ = settle_drag;
}

StepReference::Body StepReference::body(int grain) const {
    return {position[grain], velocity[grain],        angular_velocity[grain], radius_[grain],
            mass(grain),     youngs_modulus_[grain], species_[grain],         &law_[grain]};
}

/// A wall is a body of radius zero at the foot of the perpendicular.
StepReference::Body StepReference::partner_of(int grain, int partner) const {
    if (!mcdem::is_wall(partner)) {
        Body there = body(partner);
        there.position = nearest_image(scene_.box, there.position, position[grain]);
        return there;
    }
    const int wall = static_cast<int>(mcdem::wall_of(partner));
    const std::array<double, 6> at{0, scene_.box.size_x, 0, scene_.box.size_y, 0, plate_z_};
    Body foot{position[grain], Vec3::Zero(), Vec3::Zero(), 0, 0, scene_.walls.youngs_modulus};
    foot.position[wall / 2] = at[wall];
    if (scene_.box.shape == mcdem::ContainerShape::cylinder && wall == 0) {
        const double radius = scene_.box.size_x / 2;
        const double angle = std::atan2(position[grain].y() - radius, position[grain].x() - radius);
        foot.position = {radius + radius * std::cos(angle), radius + radius * std::sin(angle),
                         position[grain].z()};
        foot.curvature = -1 / radius;
    }
    if (mcdem::wall_of(partner) == mcdem::Wall::plate) {
        foot.velocity.z() = plate_velocity_;
        const Vec3 middle(scene_.box.size_x / 2, scene_.box.size_y / 2, plate_z_);
        const Vec3 along_x(1, 0, scene_.effects.plate_tilt_x), along_y(0, 1, scene_.effects.plate_tilt_y);
        const Vec3 out = along_x.cross(along_y).normalized();
        foot.position = position[grain] + (middle - position[grain]).dot(out) * out;
    }
    return foot;
}

double StepReference::distance_to(int grain, int partner) const {
    return (partner_of(grain, partner).position - position[grain]).norm();
}

void StepReference::list_neighbours() {
    const int count = static_cast<int>(position.size());
    auto before = std::move(memory);
    memory.assign(count, {});
    for (int i = 0; i < count; ++i)
        for (int j = -mcdem::wall_count; j < count; ++j) {
            if (!is_there(scene_.box, j)) continue;
            const double there = mcdem::is_wall(j) ? 0 : radius_[j];
            if (j == i || distance_to(i, j) >= radius_[i] + there + reach_) continue;
            const auto found = before[i].find(j);
            memory[i][j] = found == before[i].end() ? Memory{} : found->second;
        }
}

/// The part of the surface displacements that counts, by the geometric overlap (effect bulge_contacts).
double StepReference::counted_displacements(double geometric, double displacements) const {
    const double least = scene_.effects.bulge_contacts;
    if (geometric <= 0) return least * displacements;
    if (geometric >= std::abs(displacements)) return displacements;
    return (least + (1 - least) * geometric / std::abs(displacements)) * displacements;
}

/// Overlap at which Hertz's law gives the force of the unloading branch; negative for a gap (plasticity).
double StepReference::plastic_overlap(double overlap, double& deepest) const {
    const double p = scene_.effects.plasticity;
    deepest = std::max(deepest, overlap);
    const double lasting = p * deepest;
    if (overlap <= lasting) return overlap - lasting;
    return deepest * (overlap - lasting) / (deepest - lasting);
}

ReferenceContact StepReference::contact_of(int i, int partner, double elapsed, Memory& memory) const {
    const bool wall = mcdem::is_wall(partner);
    const Body a = body(i), b = partner_of(i, partner);
    const PairConstants pair = pair_constants(a, b);
    const double distance = (b.position - a.position).norm();
    const double displacement_there = wall ? 0 : this->memory[partner].at(i).predicted;
    ReferenceContact contact;
    contact.grain = i;
    contact.partner = partner;
    contact.direction = (b.position - a.position) / distance;
    contact.displacement = memory.predicted;
    const double geometric = a.radius + b.radius - distance;
    const double overlap = plastic_overlap(
        geometric + counted_displacements(geometric, contact.displacement + displacement_there),
        memory.deepest);
    if (!(overlap > 0)) {
        memory.spring.setZero();
        memory.rolling.setZero();
        memory.contact_radius = 0;
        memory.relaxed *= std::exp(-elapsed / scene_.effects.relaxation_time);
        contact.arm = a.radius + contact.displacement;
        const Attraction pull = attraction(overlap, pair);
        contact.force = pull.force * contact.direction;
        contact.energy = pull.energy;
        return contact;
    }
    const bool self_term = law_[i].self[0] != 0;
    contact.overlap = self_term ? self_consistent_overlap(overlap, a, b, pair) : overlap;
    contact.contact_radius = std::sqrt(pair.radius * contact.overlap);
    contact.elastic = 4.0 / 3 * pair.modulus * std::sqrt(pair.radius) * std::pow(contact.overlap, 1.5);
    const double own = self_term ? self_compliance(contact.contact_radius, a) * contact.elastic : 0;
    const double other = self_term ? self_compliance(contact.contact_radius, b) * contact.elastic : 0;
    contact.displacement += own;
    const double outer = a.radius + contact.displacement, outer_there = b.radius + displacement_there + other;
    contact.arm = wall ? a.radius - geometric : (outer + distance - outer_there) / 2;
    add_forces(contact, a, b, pair, elapsed, memory);
    return contact;
}

/// Forces and torque of a contact: normal force with damping, friction, rolling resistance.
void StepReference::add_forces(ReferenceContact& contact, const Body& a, const Body& b,
                               const PairConstants& pair, double elapsed, Memory& memory) const {
    const auto& effects = scene_.effects;
    const Vec3& e = contact.direction;
    const double distance = (b.position - a.position).norm();
    const double x = effects.stiffening * contact.overlap / pair.radius, power = 1.5 + effects.law_exponent;
    contact.elastic *= std::pow(10 * contact.overlap / pair.radius, effects.law_exponent);
    contact.elastic *= x > 0 ? 1 + x : 1 / (1 - x);
    const double potential = 1 / (power + 1), next = 1 / (power + 2);
    contact.energy = contact.elastic * contact.overlap *
                     (x > 0 ? (potential + next * x) / (1 + x)
                            : (potential - next * x) / (1 - (2 * next / potential - 1) * x));
    const double relaxed_force = std::max(0.0, contact.elastic - effects.viscoelasticity * memory.relaxed);
    const double left = std::exp(-elapsed / effects.relaxation_time);
    memory.relaxed = contact.elastic * (1 - left) + memory.relaxed * left;
    contact.energy -= potential * (contact.elastic - relaxed_force) * contact.overlap;
    contact.energy *= 1 - effects.plasticity;

    const Vec3 r_a = contact.arm * e, r_b = (contact.arm - distance) * e;
    // velocity of the other side's material at the contact point relative to this side's
    const Vec3 relative =
        (b.velocity + b.angular_velocity.cross(r_b)) - (a.velocity + a.angular_velocity.cross(r_a));
    const double stiffness = 2 * pair.modulus * std::sqrt(pair.radius * contact.overlap);
    const double approaching = -relative.dot(e);
    const double normal = relaxed_force + pair.damping * std::sqrt(stiffness * pair.mass) * approaching;
    const Attraction pull = attraction(contact.overlap, pair);
    contact.energy += pull.energy;
    const double limit =
        pair.friction * std::abs(std::max(normal, 0.0) - effects.net_force_friction * pull.force);
    const bool named_saturated = scene_.contact.friction_law == mcdem::FrictionLaw::saturated;
    const double h = effects.friction_history, mindlin = named_saturated ? h : 1 - h;
    const bool springs = mindlin > 0 || effects.rolling_resistance > 0;
    const Vec3 before = springs ? direction_before(contact, a, b, elapsed) : e;
    const double slope = e.cross(before).norm() / e.dot(before);
    // Springs follow the arc of the centres' motion, not its chord.
    const Vec3 sliding = across(relative, e) + slope * slope / 6 * across(b.velocity - a.velocity, e);
    carry_springs(contact, a, b, elapsed, memory);
    if (mindlin > 0) contact.tangential = mindlin * mindlin_friction(limit, sliding, pair, elapsed, memory);
    if (mindlin < 1) contact.tangential += (1 - mindlin) * saturated_friction(limit, sliding, pair);
    contact.couple = rolling_couple(normal, a, b, pair, elapsed, memory);
    const double shear = 8 * pair.shear_modulus * memory.contact_radius;
    contact.spring_energy =
        (mindlin * memory.spring.squaredNorm() + memory.rolling.squaredNorm() / std::pow(pair.radius, 2)) /
        (2 * shear);
    contact.force = (pull.force - normal) * e + contact.tangential;
}

/// Adhesion: 2 pi w R* in contact, decreasing linearly in a gap. Cohesion: k 2 pi R* overlap.
StepReference::Attraction StepReference::attraction(double overlap, const PairConstants& pair) const {
    const double pull_off_force = 2 * pi * scene_.effects.adhesion * pair.radius;
    const double resolved = 20 * time_step_ * time_step_ * pull_off_force / pair.mass;
    const double range = std::min(std::max(0.01 * pair.radius, resolved), probe_gap_);
    if (overlap <= -range) return {};
    if (overlap <= 0)
        return {pull_off_force * (1 + overlap / range),
                -pull_off_force * std::pow(range + overlap, 2) / (2 * range)};
    const double cohesion = 2 * pi * scene_.effects.cohesion * pair.radius * overlap;
    return {pull_off_force + cohesion, -pull_off_force * (range / 2 + overlap) - cohesion * overlap / 2};
}

std::vector<ReferenceContact> StepReference::neighbours() const {
    std::vector<ReferenceContact> all;
    for (std::size_t i = 0; i < memory.size(); ++i)
        for (const auto& [partner, remembered] : memory[i]) {
            Memory copy = remembered;
            all.push_back(contact_of(static_cast<int>(i), partner, 0, copy));
        }
    return all;
}

/// Surface displacements by the forces of this step, extrapolated to the next:
/// b(t + dt) = (10 b(t) - 5 b(t - 2 dt) + b(t - 4 dt)) / 6.
void StepReference::displace_surfaces(const std::vector<std::vector<ReferenceContact>>& contacts) {
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        Grain grain{radius_[i], youngs_modulus_[i], material_[i].poisson_ratio, {}};
        for (const ReferenceContact& c : contacts[i])
            grain.slots.push_back({c.direction, c.arm, c.elastic, c.contact_radius});
        auto moved = surface_displacement(law_[i], grain);
        for (std::size_t c = 0; c < moved.size(); ++c) {
            if (contacts[i][c].elastic > 0)  // a contact's self displacement is part of its overlap
                moved[c] -= self_displacement(law_[i], grain, grain.slots[c]) * contacts[i][c].elastic /
                            (grain.youngs_modulus * grain.radius);
            Memory& m = memory[i].at(contacts[i][c].partner);
            m.predicted = (10 * moved[c] - 5 * m.past[1] + m.past[3]) / 6;
            m.past = {moved[c], m.past[0], m.past[1], m.past[2]};
        }
    }
}

StepReference::Accelerations StepReference::accelerations(
    const std::vector<ReferenceContact>& contacts) const {
    Accelerations of{std::vector<Vec3>(position.size(), Vec3::Zero()),
                     std::vector<Vec3>(position.size(), Vec3::Zero())};
    for (const ReferenceContact& c : contacts) {
        const double m = mass(c.grain), inertia = 0.4 * m * radius_[c.grain] * radius_[c.grain];
        of.linear[c.grain] += c.force / m;
        of.angular[c.grain] += ((c.arm * c.direction).cross(c.tangential) + c.couple) / inertia;
    }
    for (std::size_t i = 0; i < position.size(); ++i) {
        of.linear[i] -= drag_ * velocity[i];
        of.linear[i].z() -= material_[i].excess_density / material_[i].density * 9.81;
        of.angular[i] -= spin_drag_ * angular_velocity[i];
    }
    return of;
}

void StepReference::step() {
    const double dt = time_step_;
    std::vector<std::vector<ReferenceContact>> contacts(position.size());
    std::vector<ReferenceContact> all;
    for (std::size_t i = 0; i < position.size(); ++i)
        for (auto& [partner, remembered] : memory[i]) {
            contacts[i].push_back(contact_of(static_cast<int>(i), partner, dt, remembered));
            all.push_back(contacts[i].back());
        }
    displace_surfaces(contacts);
    const Accelerations change = accelerations(all);
    for (std::size_t i = 0; i < position.size(); ++i) {
        velocity[i] += dt * change.linear[i];
        angular_velocity[i] += dt * change.angular[i];
        position[i] += velocity[i] * dt;
    }
    plate_z_ += plate_velocity_ * dt;
}

/// Energy stored by the surface displacements of sphere models: the integral of the displacements over
/// forces that increase in proportion from zero, with contact radii as their cube roots. Midpoint rule.
double StepReference::displacement_energy() const {
    constexpr int parts = 200;
    double energy = 0;
    std::vector<Grain> grains;
    for (std::size_t i = 0; i < position.size(); ++i)
        grains.push_back({radius_[i], youngs_modulus_[i], material_[i].poisson_ratio, {}});
    for (const ReferenceContact& c : neighbours())
        grains[c.grain].slots.push_back({c.direction, c.arm, c.elastic, c.contact_radius});
    for (std::size_t i = 0; i < grains.size(); ++i) {
        const Grain& whole = grains[i];
        for (int part = 0; part < parts; ++part) {
            const double t = (part + 0.5) / parts;
            Grain grain = whole;
            for (Slot& slot : grain.slots) {
                slot.force *= t;
                slot.contact_radius *= std::cbrt(t);
            }
            const auto moved = surface_displacement(law_[i], grain);
            for (std::size_t c = 0; c < moved.size(); ++c) energy += whole.slots[c].force * moved[c] / parts;
        }
    }
    return energy;
}

Totals StepReference::totals() const {
    Totals totals;
    totals.wall_force.fill(Vec3::Zero());
    // Velocities are half a step behind the positions.
    const auto contacts = neighbours();
    const Accelerations change = accelerations(contacts);
    for (std::size_t i = 0; i < position.size(); ++i) {
        const double m = mass(static_cast<int>(i));
        const Vec3 now = velocity[i] + time_step_ / 2 * change.linear[i],
                   spin = angular_velocity[i] + time_step_ / 2 * change.angular[i];
        totals.kinetic_energy +=
            0.5 * m * now.squaredNorm() + 0.5 * 0.4 * m * radius_[i] * radius_[i] * spin.squaredNorm();
    }
    const bool finite = law_[0].self[0] != 0;
    if (finite) totals.elastic_energy += displacement_energy();
    for (const ReferenceContact& c : contacts) {
        const bool wall = mcdem::is_wall(c.partner);
        // energy of the contact (half for a pair of grains), minus the work of the grain's surface
        // displacement
        totals.elastic_energy +=
            (wall ? 1 : 0.5) * (c.energy + c.spring_energy) - (finite ? 1 : 0.5) * c.elastic * c.displacement;
        const double one = radius_[c.grain], other = wall ? one : radius_[c.partner];
        const double scale = wall ? one : (one + other) * std::min(one, other) / std::max(one, other);
        totals.deepest_overlap = std::max(totals.deepest_overlap, c.overlap / scale);
        if (wall) totals.wall_force[static_cast<int>(mcdem::wall_of(c.partner))] -= c.force;
    }
    return totals;
}

}  // namespace mcdem::reference
