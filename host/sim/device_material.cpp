#include "sim/device_material.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/constants.h"
#include "core/container.h"
#include "elasticity/surface_displacement.h"

namespace mcdem::inline sim {
namespace {

using std::numbers::pi;
static_assert(max_species == MAX_SPECIES);

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

/// E and nu of a grain's contact partner, and the friction and restitution of the pair.
template <class Material>
void set_pair(Material& m, std::size_t other, const GrainMaterial& g, double e, double nu,
              const PairLaw& law) {
    m.modulus[other] = reduced_modulus(g.youngs_modulus, g.poisson_ratio, e, nu);
    m.shear[other] = reduced_shear_modulus(g.youngs_modulus, g.poisson_ratio, e, nu);
    m.damping[other] = damping_factor(law.restitution);
    m.friction[other] = law.friction;
}

template <class Material>
void set_pairs(Material& m, const Replica& replica, const std::vector<GrainMaterial>& all, std::size_t s) {
    for (std::size_t other = 0; other < all.size(); ++other)
        set_pair(m, other, all[s], all[other].youngs_modulus, all[other].poisson_ratio,
                 pair_law(replica, s, other));
    set_pair(m, WALL_COLUMN, all[s], replica.walls.youngs_modulus, replica.walls.poisson_ratio,
             wall_law(replica, s));
}

template <class Material>
void set_surface(Material& m, const Replica& replica, const GrainMaterial& g) {
    const double e = g.youngs_modulus, nu = g.poisson_ratio;
    const auto surface =
        surface_law(replica.contact.model, nu, replica.contact.gamma, replica.effects.finite_strain);
    m.half_space_scale = -surface.gamma * (1 + nu) / (2 * pi * e);
    m.half_space_normal = 3 - 4 * nu;
    m.half_space_shear = 1 - 2 * nu;
    m.sphere_scale = 1 / e;
    std::copy(surface.point.begin(), surface.point.end(), m.sphere_point);
    std::copy(surface.size.begin(), surface.size.end(), m.sphere_size);
    std::copy(surface.self.begin(), surface.self.end(), m.sphere_self);
    m.confinement_hertz = surface.confinement.hertz;
    m.confinement_coupling = surface.confinement.coupling;
    m.confinement_size = surface.confinement.size;
    m.confinement_volume = surface.confinement.volume;
    m.confinement_shear = surface.confinement.shear;
    std::copy(surface.confinement.bulk.begin(), surface.confinement.bulk.end(), m.confinement_bulk);
}

template <class Material>
Material device_material(const Replica& replica, const std::vector<GrainMaterial>& all, std::size_t s) {
    const GrainMaterial& g = all[s];
    Material m{};
    m.density = g.density;
    m.relative_density = g.density / all[0].density;
    m.weight_density = is_cell(replica.box) ? 0 : g.excess_density * gravity;
    m.grain_compliance = (1 - g.poisson_ratio * g.poisson_ratio) / g.youngs_modulus;
    m.shear_compliance = (2 - g.poisson_ratio) / shear_modulus(g.youngs_modulus, g.poisson_ratio);
    set_pairs(m, replica, all, s);
    set_surface(m, replica, g);
    return m;
}

}  // namespace

double damping_factor(double restitution) {
    const double log_e = std::log(restitution);
    return 2 * std::sqrt(5.0 / 6.0) * -log_e / std::sqrt(log_e * log_e + pi * pi);
}

int materials_kept(const std::vector<Replica>& replicas) {
    const bool several = std::ranges::any_of(replicas, [](const Replica& r) { return r.species.size() > 1; });
    return several ? MAX_SPECIES : 1;
}

template <class Material>
std::vector<Material> device_materials(const std::vector<Replica>& replicas, int kept) {
    std::vector<Material> all(replicas.size() * static_cast<std::size_t>(kept));
    for (std::size_t r = 0; r < replicas.size(); ++r) {
        const auto known = materials(replicas[r]);
        for (std::size_t s = 0; s < known.size(); ++s)
            all[r * static_cast<std::size_t>(kept) + s] = device_material<Material>(replicas[r], known, s);
    }
    return all;
}

template std::vector<f32::Material> device_materials(const std::vector<Replica>&, int);
template std::vector<f64::Material> device_materials(const std::vector<Replica>&, int);

}  // namespace mcdem::sim
