#include "sim/device_replica.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/container.h"
#include "elasticity/surface_displacement.h"
#include "scene/packing/make_packing.h"
#include "scene/packing/true_grains.h"
#include "sim/device_material.h"

namespace mcdem::inline sim {
namespace {

using std::numbers::pi;

template <class DeviceReplica>
void set_effects(DeviceReplica& d, const Replica& replica) {
    const Effects& e = replica.effects;
    const auto on = [&](bool wanted, int bit) { d.effects |= wanted ? bit : 0; };
    on(e.modulus_scatter > 0, EFFECT_MODULUS_SCATTER);
    on(e.bulge_contacts != 1, EFFECT_BULGE_CONTACTS);
    d.bulge_contacts = e.bulge_contacts;
    on(e.plasticity > 0, EFFECT_PLASTICITY);
    d.plasticity = e.plasticity;
    on(e.stiffening != 0, EFFECT_STIFFENING);
    d.stiffening = e.stiffening;
    on(e.law_exponent != 0, EFFECT_LAW_EXPONENT);
    d.law_exponent = e.law_exponent;
    on(e.viscoelasticity > 0, EFFECT_VISCOELASTICITY);
    d.viscoelasticity = e.viscoelasticity;
    on(e.adhesion > 0 || e.cohesion > 0, EFFECT_ATTRACTION);
    d.adhesion = 2 * pi * e.adhesion;
    d.cohesion = 2 * pi * e.cohesion;
    d.net_force_friction = e.net_force_friction;
    const double mindlin = mindlin_share(replica);
    on(mindlin > 0 && mindlin < 1, EFFECT_FRICTION_HISTORY);
    d.mindlin_share = mindlin;
    on(e.rolling_resistance > 0, EFFECT_ROLLING_RESISTANCE);
    d.rolling_resistance = e.rolling_resistance;
    on(e.plate_tilt_x != 0 || e.plate_tilt_y != 0, EFFECT_PLATE_TILT);
    d.plate_tilt_x = e.plate_tilt_x;
    d.plate_tilt_y = e.plate_tilt_y;
}

template <class DeviceReplica>
void set_contact_law(DeviceReplica& d, const Replica& replica) {
    d.material = device_materials<decltype(d.material)>({replica}, materials_kept({replica}))[0];
    d.drag = replica.grains.drag;
    d.sliding_velocity = replica.contact.sliding_velocity;
    const bool keeps_displacement = replica.contact.friction_law == FrictionLaw::mindlin_displacement;
    if (mindlin_share(replica) > 0) d.mindlin = keeps_displacement ? MINDLIN_DISPLACEMENT : MINDLIN_FORCE;
    for (const GrainMaterial& material : materials(replica)) {
        const auto surface = surface_law(replica.contact.model, material.poisson_ratio, replica.contact.gamma,
                                         replica.effects.finite_strain);
        d.surface = static_cast<int>(surface.shape);
        d.finite_contacts |= surface.self[0] != 0;
        d.confinement |= surface.confinement.coupling != 0;
    }
}

/// A grid for `span` cells that is repeated if there are too many. With three cells per side the 27 cells
/// around a grain are all different.
std::array<int, 3> repeated_grid(std::array<int, 3> span, std::size_t grains) {
    const auto most = static_cast<double>(max_cells(grains));
    while (double(span[0]) * span[1] * span[2] > most) {
        int& longest = *std::ranges::max_element(span);
        longest = std::max(3, longest / 2);
    }
    return span;
}

/// No neighbour is lost by rounding: the margin is 0.001 of a cell, and the positions of two grains are
/// accurate to a ten-thousandth of a cell each.
template <class Real>
constexpr double max_along = 0.0002 / std::numeric_limits<Real>::epsilon();
constexpr double rounding_margin = 1.001;

std::array<double, 3> sizes(const Replica& replica) {
    const Box box = true_box(replica);
    return {box.size_x, box.size_y, replica.plate.start};
}

/// `reach`: largest distance to the centre of a neighbour [m].
template <class DeviceReplica>
void set_cells(DeviceReplica& d, const Replica& replica, double reach, std::size_t grains) {
    using Real = decltype(d.skin);
    const auto size = sizes(replica);
    const double cell =
        std::max(rounding_margin * reach, *std::ranges::max_element(size) / std::min(max_along<Real>, 1e9));
    std::array<int, 3> span;
    for (int axis = 0; axis < 3; ++axis) span[axis] = std::max(1, static_cast<int>(size[axis] / cell));
    std::fill_n(d.cell_size, 3, cell);
    const auto grid = repeated_grid(span, grains);
    // Around a periodic boundary the stored grid must repeat as well; the last cell is wider.
    for (int axis = 0; axis < 2 && is_periodic(replica.box); ++axis) span[axis] -= span[axis] % grid[axis];
    d.span_x = span[0], d.span_y = span[1], d.span_z = span[2];
    d.cells_x = grid[0], d.cells_y = grid[1], d.cells_z = grid[2];
}

/// Grains are sorted into the grid by undeformed coordinates; the distance of neighbours in these depends on
/// the deformation. The stored grid does not change, and a part of it is used.
template <class DeviceReplica>
void set_deformed_cells(DeviceReplica& d, const Replica& replica, double reach, const Strain& strain) {
    using Real = decltype(d.skin);
    const Mat3 inverse = inverse_deformation(strain);
    const auto size = sizes(replica);
    const int most[]{d.cells_x, d.cells_y, d.cells_z};
    int* const span[]{&d.span_x, &d.span_y, &d.span_z};
    for (int axis = 0; axis < 3; ++axis) {
        const double width =
            std::max(rounding_margin * reach * inverse.row(axis).norm(), size[axis] / max_along<Real>);
        *span[axis] = std::clamp(static_cast<int>(std::min(size[axis] / width, 1e9)), 1, most[axis]);
        d.cell_size[axis] = size[axis] / *span[axis];
    }
}

template <class DeviceReplica>
void set_space(DeviceReplica& d, const Replica& replica, const Packing& packing) {
    const double radius = mean_radius(packing);
    const double skin = replica.numerics.skin * radius;
    d.skin = skin;
    d.max_move = 0.5 * (is_cell(replica.box) ? 1 - cell_share : 1) * static_cast<double>(d.skin);
    d.probe_gap = replica.numerics.probe_gap * radius;
    d.overlap_limit = replica.numerics.overlap_limit;
    d.container = static_cast<int>(replica.box.shape);
    const auto size = sizes(replica);
    for (int axis = 0; axis < 3; ++axis) d.wall_position[2 * axis + 1] = size[axis];
    std::fill_n(d.deformation, 3, 1);
    set_cells(d, replica, list_reach(replica, packing), packing.size());
    if (is_cell(replica.box)) set_deformed_cells(d, replica, list_reach(replica, packing), {});
}

double time_step_of(const Replica& replica, const GrainMaterial& material, double radius) {
    return replica.numerics.time_step * pi * radius / rayleigh_speed(material);
}

}  // namespace

Box true_box(const Replica& replica) {
    Box box = replica.box;
    box.size_x += replica.effects.width_error_x;
    box.size_y += is_cylinder(box) ? replica.effects.width_error_x : replica.effects.width_error_y;
    return box;
}

double mean_radius(const Packing& packing) {
    return 0.5 * std::accumulate(packing.diameter.begin(), packing.diameter.end(), 0.0) /
           static_cast<double>(packing.size());
}

double list_reach(const Replica& replica, const Packing& packing) {
    return list_reach(replica.numerics, 2 * mean_radius(packing),
                      *std::ranges::max_element(packing.diameter));
}

double time_step(const Replica& replica, const Packing& packing) {
    const auto excess = excess_compliance(replica, packing.size());
    const auto all = materials(replica);
    // For each species, the radius of a grain of mean stiffness with the Rayleigh time of the fastest grain.
    std::vector<double> smallest(all.size(), std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < packing.size(); ++i) {
        double& radius = smallest[packing.species_of(i)];
        radius = std::min(radius, 0.5 * packing.diameter[i] * std::sqrt(1 + excess[i]));
    }
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t s = 0; s < all.size(); ++s)
        shortest = std::min(shortest, time_step_of(replica, all[s], smallest[s]));
    return shortest;
}

double time_step(const Replica& replica, double radius) {
    double shortest = std::numeric_limits<double>::infinity();
    for (const GrainMaterial& material : materials(replica))
        shortest = std::min(shortest, time_step_of(replica, material, radius));
    return shortest;
}

/// Contacts stiffen within an interval, and modes are mixed.
constexpr double part_of_stable_step = 0.9;

int shortening(double time_step, double step_rate, int now) {
    const double ratio = time_step * step_rate / part_of_stable_step;
    const int needed = ratio > 1 ? static_cast<int>(std::ceil(8 * std::log2(std::min(ratio, 1e3)))) : 0;
    const bool keep = needed <= now && now < needed + 5;
    return keep ? now : std::min(needed, max_shortening);
}

double shortened(double time_step, int shortening) { return time_step * std::exp2(-shortening / 8.0); }

template <class DeviceReplica>
void set_time_step(DeviceReplica& d, const Replica& replica, double time_step) {
    d.time_step = time_step;
    d.relaxing_share = -std::expm1(-time_step / replica.effects.relaxation_time);
}

template <class DeviceReplica>
void set_strain(DeviceReplica& d, const Replica& replica, const Strain& strain, const Strain& rate,
                double reach) {
    for (std::size_t k = 0; k < strain.size(); ++k) {
        d.deformation[k] = k < 3 ? 1 - strain[k] : strain[k];
        d.deformation_rate[k] = k < 3 ? -rate[k] : rate[k];
    }
    if (reach > 0) set_deformed_cells(d, replica, reach, strain);
}

template <class DeviceReplica>
DeviceReplica device_replica(const Replica& replica, const Packing& packing, const Place& place) {
    DeviceReplica d{};
    set_time_step(d, replica, time_step(replica, packing));
    set_contact_law(d, replica);
    set_effects(d, replica);
    set_space(d, replica, packing);
    d.first_grain = place.first_grain;
    d.grain_count = place.grain_count;
    d.first_cell = place.first_cell;
    return d;
}

template void set_time_step(f32::Replica&, const Replica&, double);
template void set_time_step(f64::Replica&, const Replica&, double);
template void set_strain(f32::Replica&, const Replica&, const Strain&, const Strain&, double);
template void set_strain(f64::Replica&, const Replica&, const Strain&, const Strain&, double);
template f32::Replica device_replica(const Replica&, const Packing&, const Place&);
template f64::Replica device_replica(const Replica&, const Packing&, const Place&);

}  // namespace mcdem::sim
