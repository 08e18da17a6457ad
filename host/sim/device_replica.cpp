#include "sim/device_replica.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/container.h"
#include "elasticity/surface_displacement.h"
#include "scene/true_grains.h"

namespace mcdem::inline sim {
namespace {

constexpr double gravity = 9.81;  // [m/s2]
constexpr double pi = std::numbers::pi;

double mean_radius(const Packing& packing) {
    return 0.5 * std::accumulate(packing.diameter.begin(), packing.diameter.end(), 0.0) /
           static_cast<double>(packing.size());
}

double shear_modulus(double youngs_modulus, double poisson_ratio) {
    return youngs_modulus / (2 * (1 + poisson_ratio));
}

/// 1/E* = (1 - nu_i^2)/E_i + (1 - nu_j^2)/E_j
double reduced_modulus(double e_i, double nu_i, double e_j, double nu_j) {
    return 1 / ((1 - nu_i * nu_i) / e_i + (1 - nu_j * nu_j) / e_j);
}

/// 1/G* = (2 - nu_i)/G_i + (2 - nu_j)/G_j  (Mindlin 1949)
double reduced_shear_modulus(double e_i, double nu_i, double e_j, double nu_j) {
    return 1 / ((2 - nu_i) / shear_modulus(e_i, nu_i) + (2 - nu_j) / shear_modulus(e_j, nu_j));
}

/// 2 sqrt(5/6) beta with beta = -ln e / sqrt(ln^2 e + pi^2): constant restitution with a Hertz contact.
double damping_factor(double restitution) {
    const double log_e = std::log(restitution);
    return 2 * std::sqrt(5.0 / 6.0) * -log_e / std::sqrt(log_e * log_e + pi * pi);
}

template <class DeviceReplica>
void set_materials(DeviceReplica& d, const Replica& replica) {
    const auto& g = replica.grains;
    const auto& w = replica.walls;
    d.density = g.density;
    d.weight_density = is_cell(replica.box) ? 0 : g.excess_density * gravity;
    d.drag = g.drag;
    d.modulus_grain = reduced_modulus(g.youngs_modulus, g.poisson_ratio, g.youngs_modulus, g.poisson_ratio);
    d.modulus_wall = reduced_modulus(g.youngs_modulus, g.poisson_ratio, w.youngs_modulus, w.poisson_ratio);
    d.shear_grain =
        reduced_shear_modulus(g.youngs_modulus, g.poisson_ratio, g.youngs_modulus, g.poisson_ratio);
    d.shear_wall =
        reduced_shear_modulus(g.youngs_modulus, g.poisson_ratio, w.youngs_modulus, w.poisson_ratio);
    d.damping_grain = damping_factor(g.restitution);
    d.damping_wall = damping_factor(w.restitution);
    d.friction_grain = g.friction;
    d.friction_wall = w.friction;
    d.sliding_velocity = replica.contact.sliding_velocity;
    d.mindlin = mindlin_share(replica) > 0;
}

template <class DeviceReplica>
void set_effects(DeviceReplica& d, const Replica& replica) {
    const Effects& e = replica.effects;
    const auto& g = replica.grains;
    const auto on = [&](bool wanted, int bit) { d.effects |= wanted ? bit : 0; };
    on(e.modulus_scatter > 0, EFFECT_MODULUS_SCATTER);
    d.grain_compliance = (1 - g.poisson_ratio * g.poisson_ratio) / g.youngs_modulus;
    d.shear_compliance = (2 - g.poisson_ratio) / shear_modulus(g.youngs_modulus, g.poisson_ratio);
    on(e.bulge_contacts != 1, EFFECT_BULGE_CONTACTS);
    d.bulge_contacts = e.bulge_contacts;
    on(e.plasticity > 0, EFFECT_PLASTICITY);
    d.plasticity = e.plasticity;
    on(e.stiffening != 0, EFFECT_STIFFENING);
    d.stiffening = e.stiffening;
    on(e.viscoelasticity > 0, EFFECT_VISCOELASTICITY);
    d.viscoelasticity = e.viscoelasticity;
    on(e.adhesion > 0, EFFECT_ADHESION);
    d.adhesion = 2 * pi * e.adhesion;
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
void set_surface(DeviceReplica& d, const Replica& replica) {
    const auto surface =
        surface_law(replica.contact.model, replica.grains.poisson_ratio, replica.contact.gamma);
    const double nu = replica.grains.poisson_ratio;
    const double e = replica.grains.youngs_modulus;
    d.surface = static_cast<int>(surface.shape);
    d.half_space_scale = -surface.gamma * (1 + nu) / (2 * pi * e);
    d.half_space_normal = 3 - 4 * nu;
    d.half_space_shear = 1 - 2 * nu;
    d.sphere_scale = 1 / e;
    std::copy(surface.point.begin(), surface.point.end(), d.sphere_point);
    std::copy(surface.size.begin(), surface.size.end(), d.sphere_size);
    std::copy(surface.self.begin(), surface.self.end(), d.sphere_self);
    d.finite_contacts = surface.self[0] != 0;
    const Confinement& c = surface.confinement;
    d.confinement_coupling = c.coupling;
    d.confinement_volume = c.volume;
    d.confinement = c.coupling != 0 || c.volume != 0;
}

/// A grid that covers `span` cells by repeating itself where they are too many. Three cells a side are enough
/// for the 27 around a grain to be different ones.
std::array<int, 3> repeated_grid(std::array<int, 3> span, std::size_t grains) {
    const auto most = static_cast<double>(max_cells(grains));
    while (double(span[0]) * span[1] * span[2] > most) {
        int& longest = *std::ranges::max_element(span);
        longest = std::max(3, longest / 2);
    }
    return span;
}

/// No neighbour is lost to rounding: the margin is 0.001 of a cell of the grid, the places of two grains
/// along the box are known to a ten-thousandth of one each.
template <class Real>
constexpr double max_along = 0.0002 / std::numeric_limits<Real>::epsilon();
constexpr double rounding_margin = 1.001;

std::array<double, 3> sizes(const Replica& replica) {
    return {replica.box.size_x, replica.box.size_y, replica.plate.start};
}

/// `reach`: the farthest that a neighbour's centre may be [m].
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
    // Around a periodic end the grid in memory must repeat as well; the last cell is wider.
    for (int axis = 0; axis < 2 && is_periodic(replica.box); ++axis) span[axis] -= span[axis] % grid[axis];
    d.span_x = span[0], d.span_y = span[1], d.span_z = span[2];
    d.cells_x = grid[0], d.cells_y = grid[1], d.cells_z = grid[2];
}

/// Grains lie in the grid undeformed; how far neighbours are apart there depends on the deformation. The grid
/// in memory stays and is used in part.
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
    d.max_move = (is_cell(replica.box) ? 0.25 : 0.5) * static_cast<double>(d.skin);
    d.probe_gap = replica.numerics.probe_gap * radius;
    d.overlap_limit = replica.numerics.overlap_limit;
    d.container = static_cast<int>(replica.box.shape);
    d.wall_position[1] = replica.box.size_x;
    d.wall_position[3] = replica.box.size_y;
    d.wall_position[5] = replica.plate.start;
    std::fill_n(d.deformation, 3, 1);
    set_cells(d, replica, list_reach(replica, packing), packing.size());
    if (is_cell(replica.box)) set_deformed_cells(d, replica, list_reach(replica, packing), {});
}

}  // namespace

double list_reach(const Replica& replica, const Packing& packing) {
    return *std::ranges::max_element(packing.diameter) +
           (replica.numerics.probe_gap + replica.numerics.skin) * mean_radius(packing);
}

double mindlin_share(const Replica& replica) {
    const double other = replica.effects.friction_history;
    return replica.contact.friction_law == FrictionLaw::mindlin ? 1 - other : other;
}

double rayleigh_speed(const GrainMaterial& g) {
    return std::sqrt(shear_modulus(g.youngs_modulus, g.poisson_ratio) / g.density) *
           (0.163 * g.poisson_ratio + 0.8766);
}

double time_step(const Replica& replica, const Packing& packing) {
    const auto excess = excess_compliance(replica, packing.size());
    double smallest =
        0.5 * packing.diameter[0] * std::sqrt(1 + excess[0]);  // grain of mean stiffness as slow as this one
    for (std::size_t i = 1; i < packing.size(); ++i)
        smallest = std::min(smallest, 0.5 * packing.diameter[i] * std::sqrt(1 + excess[i]));
    return time_step(replica, smallest);
}

double time_step(const Replica& replica, double radius) {
    return replica.numerics.time_step * pi * radius / rayleigh_speed(replica.grains);
}

/// The limit of stability over a report's frequency goes with the fifth root of the damping, as the
/// extrapolation's phase error goes with the fifth power of the step (ARCHITECTURE.md). 0.7 was measured at a
/// restitution of 0.95 (tests/truth/README.md). Hardly damped contacts are pumped slowly.
double stable_phase(double restitution) {
    return 0.7 * std::clamp(std::pow(damping_factor(restitution) / damping_factor(0.95), 0.2), 0.5, 1.0);
}

int shortening(const Replica& replica, double time_step, double frequency, int now) {
    const ContactModel model = replica.contact.model;
    if (model != ContactModel::elastic_sphere && model != ContactModel::hyperelastic_sphere) return 0;
    const double ratio = time_step * frequency / stable_phase(replica.grains.restitution);
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
    set_materials(d, replica);
    set_effects(d, replica);
    set_surface(d, replica);
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
