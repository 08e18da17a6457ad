#include "diagnose/effects.h"

#include <algorithm>
#include <cmath>

#include "core/container.h"

namespace mcdem::inline diagnose {
namespace {

bool interacting(const Model& m) { return m.replica.contact.model != ContactModel::independent; }

double reduced_modulus(const Model& m) {
    const double nu = m.replica.grains.poisson_ratio;
    return m.replica.grains.youngs_modulus / (2 * (1 - nu * nu));
}

// Natural scales: amplitudes over these are comparable for soft and stiff, small and large grains.
double one(const Model&) { return 1; }
double grain_diameter(const Model& m) { return m.mean_diameter; }
double adhesive_scale(const Model& m) { return reduced_modulus(m) * m.mean_diameter / 4; }  // E* R*
double cohesive_scale(const Model& m) { return reduced_modulus(m); }
double compliance_scale(const Model& m) {
    return 1 / (m.replica.grains.youngs_modulus * std::max(m.replica.box.size_x, m.replica.box.size_y));
}
double excess_density(const Model& m) {
    return std::max(std::abs(m.replica.grains.excess_density), 0.02 * m.replica.grains.density);
}
double friction_scale(const Model& m) { return std::max(m.replica.grains.friction, 0.02); }
double wall_friction_scale(const Model& m) { return std::max(m.replica.walls.friction, 0.02); }
double inverse_force(const Model& m) {
    return 1 / (m.replica.grains.youngs_modulus * m.mean_diameter * m.mean_diameter);
}
double threshold_scale(const Model& m) { return m.instrument.stated.force_threshold; }

/// Adds the fraction `a` of the remainder 1 - share.
void add_share(double& share, double a) { share += a * (1 - share); }

/// Effects of numerics reduce settings by a fraction `part`. Runs take at most this factor longer.
constexpr double max_slowdown = 8;
void take_off(const std::vector<NumericalSetting>& settings, double part) {
    for (const NumericalSetting& setting : settings) *setting.value *= std::max(1 - part, 1 / max_slowdown);
}
std::vector<NumericalSetting> plate_speed(Model& m) {
    std::vector<NumericalSetting> all;
    if (m.replica.protocol.rate_tolerance > 0)
        all.push_back({"protocol.rate_tolerance", &m.replica.protocol.rate_tolerance});
    all.push_back({"plate.speed", &m.replica.plate.speed});
    for (Stage& stage : m.replica.programme)
        if (!std::isnan(stage.speed)) all.push_back({"plate.speed", &stage.speed});
    return all;
}
std::vector<NumericalSetting> density(Model& m) { return {{"grains.density", &m.replica.grains.density}}; }
std::vector<NumericalSetting> time_step(Model& m) {
    return {{"numerics.time_step", &m.replica.numerics.time_step}};
}

/// With a rate tolerance up to this value, the plate's speed is not tested by runs.
constexpr double slow_tolerance = 0.01;

/// Speed and inertia affect results only through the inertial number, which such a plate limits.
std::string_view slow_enough(const Model& m) {
    const double tolerance = m.replica.protocol.rate_tolerance;
    return tolerance > 0 && tolerance <= slow_tolerance
               ? "protocol.rate_tolerance keeps what the plate's speed and inertia add below 1 % of mean "
                 "forces; `mcdem converge` measures it"
               : "";
}

std::string_view no_slower_plate(const Model& m) {
    if (const auto reason = slow_enough(m); !reason.empty()) return reason;
    return m.experiment_speed && *m.experiment_speed >= m.replica.plate.speed
               ? "the experiment's plate is stated to move as fast as the scene's"
               : "";
}
std::string_view nothing(const Model&) { return ""; }
std::string_view interacting_already(const Model& m) {
    return interacting(m) ? "the contacts of the scene interact already" : "";
}
std::string_view independent_contacts(const Model& m) {
    return interacting(m) ? "" : "independent contacts have no surface displacements";
}
std::string_view not_elastic_sphere(const Model& m) {
    return m.replica.contact.model == ContactModel::elastic_sphere
               ? ""
               : "only grains of elastic_sphere have a law of finite strain, hyperelastic_sphere";
}
std::string_view no_friction(const Model& m) {
    return m.replica.grains.friction > 0 ? "" : "the scene has no friction";
}
std::string_view no_other_limit(const Model& m) {
    if (m.replica.effects.adhesion > 0)
        return "the scene has adhesion; effects.net_force_friction sets its Coulomb limit";
    return no_friction(m);
}
std::string_view no_sides(const Model& m) {
    return is_periodic(m.replica.box)
               ? "a periodic container repeats: its plate is level, and its period gives the scale of lengths"
               : "";
}
std::string_view no_threshold(const Model& m) {
    return m.instrument.stated.force_threshold > 0 ? "" : "the experiment states no force threshold";
}

// clang-format off
const Effect all_effects[] = {
    {"cross_contact", "cross-contact deformation", "", "gamma of the paper's Eq. 1: the force at a contact displaces the surface at all other contacts", "Brodu, Dijksman & Behringer 2015",
     0, 1.8, 0.5, 1.0, one, [](Model& m, double a) { m.replica.contact.model = ContactModel::mc_dem; m.replica.contact.gamma = a; }, interacting_already},
    {"bulge_contacts", "contacts made by surface displacement", "", "fraction of the surface displacement that creates no contact between spheres that do not overlap undeformed", "Brodu, Dijksman & Behringer 2015",
     0, 1, 0.5, 1.0, one, [](Model& m, double a) { m.replica.effects.bulge_contacts *= 1 - a; }, independent_contacts},
    {"friction", "friction between grains", "", "change of mu between grains", "Coulomb",
     -1, 8, -0.7, 2.5, friction_scale, [](Model& m, double a) { m.replica.grains.friction = std::max(0.0, m.replica.grains.friction + a); }, nothing},
    {"wall_friction", "friction at the walls", "", "change of mu at walls", "Coulomb",
     -1, 8, -0.7, 2.5, wall_friction_scale, [](Model& m, double a) { m.replica.walls.friction = std::max(0.0, m.replica.walls.friction + a); }, nothing},
    {"friction_history", "friction with memory", "", "share of the other law of friction (saturated or Mindlin's)", "Mindlin & Deresiewicz 1953",
     0, 1, 0.5, 1.0, one, [](Model& m, double a) { add_share(m.replica.effects.friction_history, a); }, no_friction},
    {"adhesion", "", "J/m2", "work of adhesion w: touching grains attract by 2 pi w R*", "Derjaguin, Muller & Toporov 1975",
     0, 0.03, 0.003, 0.01, adhesive_scale, [](Model& m, double a) { m.replica.effects.adhesion += a; }, nothing},
    {"adhesion_net_friction", "adhesion with friction of the net force", "J/m2", "adhesion where Coulomb's law holds for the net force", "Derjaguin, Muller & Toporov 1975",
     0, 0.03, 0.003, 0.01, adhesive_scale, [](Model& m, double a) { m.replica.effects.adhesion += a; if (a > 0) m.replica.effects.net_force_friction = 1; }, no_other_limit},
    {"cohesion", "cohesion per contact area", "J/m3", "k: attraction over the area 2 pi R* overlap of a contact", "\"SJKR\" of LIGGGHTS",
     0, 0.1, 0.005, 0.02, cohesive_scale, [](Model& m, double a) { m.replica.effects.cohesion += a; }, nothing},
    {"viscoelasticity", "", "", "fraction of the Hertz force that relaxes while a contact is held", "standard linear solid",
     0, 0.8, 0.1, 0.3, one, [](Model& m, double a) { add_share(m.replica.effects.viscoelasticity, a); }, nothing},
    {"stiffening", "stiffening at large strain", "", "c in F = F_Hertz (1 + c overlap/R*)", "first correction to Hertz at large strain",
     -1.5, 4, -0.7, 1.2, one, [](Model& m, double a) { m.replica.effects.stiffening += a; }, nothing},
    {"finite_strain", "finite strain of the grains", "", "fraction of the finite-strain correction of an elastic sphere", "finite elements of a neo-Hookean sphere",
     0, 1, 0.5, 1.0, one, [](Model& m, double a) { add_share(m.replica.effects.finite_strain, a); }, not_elastic_sphere},
    {"plasticity", "", "", "fraction of the largest overlap that remains after unloading", "Walton & Braun 1986",
     0, 0.5, 0.05, 0.15, one, [](Model& m, double a) { add_share(m.replica.effects.plasticity, a); }, nothing},
    {"buoyancy", "weight under buoyancy", "kg/m3", "change of the grains' density over the fluid's", "Archimedes",
     -8, 30, -2.5, 2.5, excess_density, [](Model& m, double a) { m.replica.grains.excess_density += a; }, nothing},
    {"diameter_error", "error of all diameters", "m", "true minus stated diameter, equal for all grains", "measurement",
     -0.03, 0.03, -0.006, 0.006, grain_diameter, [](Model& m, double a) { m.replica.effects.diameter_error += a; }, nothing},
    {"polydispersity", "scatter of diameters", "m", "standard deviation of true minus stated diameter", "measurement",
     0, 0.05, 0.008, 0.02, grain_diameter, [](Model& m, double a) { m.replica.effects.polydispersity += a; }, nothing},
    {"modulus_scatter", "scatter of moduli", "", "standard deviation of ln E from grain to grain", "log-normal scatter",
     0, 0.8, 0.15, 0.4, one, [](Model& m, double a) { m.replica.effects.modulus_scatter += a; }, nothing},
    {"rolling_resistance", "", "", "mu_r: a spring resists rolling and yields at the torque mu_r R* F_n", "Iwashita & Oda 1998; Ai et al. 2011, model C",
     0, 1.5, 0.5, 1.5, friction_scale, [](Model& m, double a) { m.replica.effects.rolling_resistance += a; }, nothing},
    {"plate_tilt", "tilt of the plate along x", "", "slope of the plate along x", "geometry",
     -0.08, 0.08, -0.015, 0.015, one, [](Model& m, double a) { m.replica.effects.plate_tilt_x += a; }, no_sides},
    {"plate_tilt_y", "tilt of the plate along y", "", "slope of the plate along y", "geometry",
     -0.08, 0.08, -0.015, 0.015, one, [](Model& m, double a) { m.replica.effects.plate_tilt_y += a; }, no_sides},
    {"plate_compliance", "compliance of the plate", "m/N", "deflection of the plate per newton", "linear spring",
     0, 1, 0.1, 0.3, compliance_scale, [](Model& m, double a) { m.replica.effects.plate_compliance += a; }, nothing},
    {"force_bias", "bias of contact forces", "relative", "relative error by which contact forces are measured too large", "measurement",
     -0.5, 0.8, -0.1, 0.1, one, [](Model& m, double a) { m.instrument.force_bias += a; }, nothing},
    {"gauge_drift", "drift of the load cell's gain", "relative", "relative error of the load cell's gain at the end of the last cycle; it grows in proportion to the plate's path", "measurement",
     -0.5, 0.8, -0.1, 0.1, one, [](Model& m, double a) { m.instrument.gauge_drift += a; }, nothing},
    {"zero_drift", "drift of the load cell's zero", "relative", "offset of the load cell at the end of the last cycle, over the maximum top force; it grows in proportion to the plate's path", "measurement",
     -0.5, 0.5, -0.03, 0.03, one, [](Model& m, double a) { m.instrument.zero_drift += a; }, nothing},
    {"gauge_hysteresis", "hysteresis of the load cell", "relative", "excess of the top force during unloading, at half the maximum force, over the maximum force", "measurement",
     -0.3, 0.3, -0.03, 0.03, one, [](Model& m, double a) { m.instrument.gauge_hysteresis += a; }, nothing},
    {"force_lag", "lag of the load cell", "m", "plate travel by which the reading of the top force lags", "measurement",
     0, 0.1, 0.01, 0.03, grain_diameter, [](Model& m, double a) { m.instrument.force_lag += a; }, nothing},
    {"guide_friction", "friction of the plate's guide", "relative", "friction of the plate's guide, which the load cell also reads, over the maximum force", "measurement",
     0, 0.3, 0.01, 0.03, one, [](Model& m, double a) { m.instrument.guide_friction += a; }, nothing},
    {"force_saturation", "saturation of contact forces", "1/N", "a in f/(1 + a f), what is read of a contact force f", "measurement",
     0, 50, 2, 6, inverse_force, [](Model& m, double a) { m.instrument.force_saturation += a; }, nothing},
    {"force_threshold", "shifted force threshold", "N", "true minus stated threshold of contact forces", "measurement",
     -1, 8, -0.5, 1.5, threshold_scale, [](Model& m, double a) { m.instrument.threshold_shift += a; }, no_threshold},
    {"position_bias", "bias of positions", "relative", "relative error by which lengths are measured too large", "measurement",
     -0.02, 0.02, -0.003, 0.003, one, [](Model& m, double a) { m.instrument.position_bias += a; }, no_sides},
    {"plate_speed", "speed of the plate", "", "fraction by which the real plate is slower than the scene's", "numerics",
     0, 1, 0.5, 0.75, one, [](Model& m, double a) { take_off(plate_speed(m), a); }, no_slower_plate, plate_speed},
    {"inertia", "inertia of the grains", "", "fraction by which real inertia is smaller than the scene's, with the same weight", "numerics",
     0, 1, 0.5, 0.75, one, [](Model& m, double a) { take_off(density(m), a); }, slow_enough, density},
    {"time_step", "", "", "fraction by which the time step is too long", "numerics",
     0, 1, 0.3, 0.6, one, [](Model& m, double a) { take_off(time_step(m), a); }, nothing, time_step},
};
// clang-format on

// Standard deviations of parameters whose uncertainty the experiment does not state.
constexpr double modulus_sigma = 0.05;
constexpr double gamma_sigma = 0.05;
constexpr double strain_zero_sigma = 0.01;  // over the mean diameter

}  // namespace

std::span<const Effect> effects() { return all_effects; }

const Effect* find_effect(std::string_view name) {
    const auto found = std::ranges::find(all_effects, name, &Effect::name);
    return found == std::end(all_effects) ? nullptr : found;
}

bool is_numerical(std::string_view name) {
    const Effect* effect = find_effect(name);
    return effect && effect->settings;
}

bool depends_on_speed(std::string_view name) {
    return name == "viscoelasticity" || name == "plate_speed" || name == "inertia";
}

std::vector<Nuisance> nuisances(const Model& model, const Experiment& experiment) {
    const auto stated = [&](const char* key) {
        const auto found = experiment.uncertainty.find(key);
        return found == experiment.uncertainty.end() ? 0.0 : found->second;
    };
    std::vector<Nuisance> list;
    const double modulus = stated("grains.youngs_modulus") / model.replica.grains.youngs_modulus;
    list.push_back({"modulus", "relative", modulus > 0 ? modulus : modulus_sigma,
                    [](Model& m, double shift) { m.replica.grains.youngs_modulus *= std::exp(shift); }});
    list.push_back({"strain_offset", "m", strain_zero_sigma * model.mean_diameter,
                    [](Model& m, double shift) { m.instrument.strain_offset += shift; }});
    if (model.replica.contact.model == ContactModel::mc_dem)
        list.push_back(
            {"gamma", "", gamma_sigma, [](Model& m, double shift) { m.replica.contact.gamma += shift; }});
    for (const auto& [name, key] :
         {std::pair{"friction", "grains.friction"}, {"wall_friction", "walls.friction"}})
        if (const double sigma = stated(key); sigma > 0)
            list.push_back({name, "", sigma, find_effect(name)->apply});
    return list;
}

}  // namespace mcdem::diagnose
