#include "scene/read/keys.h"

#include <algorithm>

#include "scene/read/key_rows.h"
#include "scene/read/list_tables.h"

namespace mcdem::inline scene {
namespace {

using namespace rows;

/// The member at the end of a path of pointers to members, starting from Settings.
template <auto... path>
auto& follow(Settings& settings, std::size_t /*element*/) {
    return (settings.*....*path);
}

template <auto... path>
constexpr auto run = &follow<&Settings::run, path...>;
template <auto... path>
constexpr auto replica = &follow<&Settings::replica, path...>;
template <auto member>
constexpr auto effect = &follow<&Settings::replica, &Replica::effects, member>;
template <auto member>
constexpr auto generated = &follow<&Settings::generated, member>;

// clang-format off
const Key table[] = {
    {"name", run<&Scene::name>, "", none, one_run, "name of the run; default: the file's name"},

    {"container.shape", replica<&Replica::box, &Box::shape>, "", none, each, "boundary at the sides, between floor and plate. box: four walls; cylinder: one upright wall with its axis at x = y = radius; periodic: no side walls, periodic along x and y; cell: no walls, floor, plate or weight, periodic along x, y and z, deformed by a programme"},
    {"container.size_x", replica<&Replica::box, &Box::size_x>, "m", length, each, "box: distance between the walls x_min and x_max; periodic and cell: period along x"},
    {"container.size_y", replica<&Replica::box, &Box::size_y>, "m", length, each, "the same along y; the floor is at z = 0"},
    {"container.radius", &follow<&Settings::cylinder_radius>, "m", length, each, "radius of a cylinder"},
    {"container.height", &follow<&Settings::cell_height>, "m", length, each, "cell with a packing file: its length along z. For a generated packing it follows from packing.count and packing.packing_fraction"},

    {"box.size_x", replica<&Replica::box, &Box::size_x>, "m", length, each, "short for container.size_x"},
    {"box.size_y", replica<&Replica::box, &Box::size_y>, "m", length, each, "short for container.size_y"},

    {"grains.youngs_modulus", replica<&Replica::grains, &GrainMaterial::youngs_modulus>, "Pa", stiffness, each, "E"},
    {"grains.poisson_ratio", replica<&Replica::grains, &GrainMaterial::poisson_ratio>, "", poisson, each, "nu"},
    {"grains.density", replica<&Replica::grains, &GrainMaterial::density>, "kg/m3", mass_density, each, "mass density; it affects inertia and time step, but not quasi-static results"},
    {"grains.excess_density", replica<&Replica::grains, &GrainMaterial::excess_density>, "kg/m3", between(-1e5, 1e5), each, "density minus that of the fluid; determines the weight; 0: weightless"},
    {"grains.friction", replica<&Replica::grains, &GrainMaterial::friction>, "", friction, each, "mu between grains"},
    {"grains.restitution", replica<&Replica::grains, &GrainMaterial::restitution>, "", bounce, each, "e between grains: rebound speed over approach speed of an isolated pair"},
    {"grains.drag", replica<&Replica::grains, &GrainMaterial::drag>, "1/s", between(0, 1e6), each, "background drag, force = -drag * mass * velocity"},

    {"walls.youngs_modulus", replica<&Replica::walls, &WallMaterial::youngs_modulus>, "Pa", stiffness, each, "E of all walls and the plate"},
    {"walls.poisson_ratio", replica<&Replica::walls, &WallMaterial::poisson_ratio>, "", poisson, each, "nu"},
    {"walls.friction", replica<&Replica::walls, &WallMaterial::friction>, "", friction, each, "mu between grain and wall"},
    {"walls.restitution", replica<&Replica::walls, &WallMaterial::restitution>, "", bounce, each, "e between grain and wall"},

    {"contact.model", replica<&Replica::contact, &ContactLaw::model>, "", none, each, "how a force at one contact displaces the surface at the grain's other contacts"},
    {"contact.gamma", replica<&Replica::contact, &ContactLaw::gamma>, "", between(0, 10), each, "prefactor of the surface displacements of mc_dem; other models do not use it"},
    {"contact.friction_law", replica<&Replica::contact, &ContactLaw::friction_law>, "", none, each, "saturated: mu times the normal force, against sliding; mindlin: a tangential spring with history, limited to that force, which keeps its force when the normal force grows and loses some in proportion to the contact radius when that decreases; mindlin_displacement: the spring keeps its displacement instead, as in LIGGGHTS; it can return more work than was put in"},
    {"contact.sliding_velocity", replica<&Replica::contact, &ContactLaw::sliding_velocity>, "m/s", above_zero_to(100), each, "sliding velocity below which saturated friction decreases to zero"},

    {"packing.file", &follow<&Settings::packing_file>, "", none, each, "LIGGGHTS/LAMMPS data file or text dump, Yade text file (x y z r), run.h5, or .csv with columns x_m,y_m,z_m,diameter_m, such as an experiment's grains.csv. A column species or type gives the [[species]] of each grain, by name or by number from 1; columns vx_m_s,vy_m_s,vz_m_s and spin_x_1_s,spin_y_1_s,spin_z_1_s of a .csv their initial velocities and spins. Path relative to the scene file (in --set: to the current folder). Default: the packing is generated"},
    {"packing.frame", &follow<&Settings::packing_frame>, "", between(-1, 2e9), each, "timestep of a dump, or frame of a grains.csv or run.h5, given as packing.file; -1: the last of a dump, the first of the others"},
    {"packing.count", generated<&GeneratedPacking::count>, "", between(1, 1e7), each, "number of generated grains"},
    {"packing.diameter_mean", generated<&GeneratedPacking::diameter_mean>, "m", grain_size, each, "mean of a normal distribution, before truncation"},
    {"packing.diameter_sd", generated<&GeneratedPacking::diameter_sd>, "m", between(0, 10), each, "its standard deviation"},
    {"packing.diameter_min", generated<&GeneratedPacking::diameter_min>, "m", grain_size, each, "lower limit of truncation"},
    {"packing.diameter_max", generated<&GeneratedPacking::diameter_max>, "m", grain_size, each, "upper limit of truncation"},
    {"packing.packing_fraction", generated<&GeneratedPacking::packing_fraction>, "", between(0.01, 0.75), each, "volume of the grains over the volume of the filled part of the box"},
    {"packing.position_jitter", replica<&Replica::packing, &PackingSource::position_jitter>, "m", between(0, 10), each, "standard deviation of a random displacement of every coordinate"},
    {"packing.fractions_by", replica<&Replica::packing, &PackingSource::fractions_by>, "", none, each, "whether the fractions of [[species]] are fractions of the number or of the volume of the grains"},
    {"packing.seed", replica<&Replica::packing, &PackingSource::seed>, "", between(0, 1e15), each, "seed for generation, jitter and assignment of species; copy n uses seed + n - 1"},

    {"plate.start", replica<&Replica::plate, &Plate::start>, "m", length, each, "highest position of its lower face"},
    {"plate.end", replica<&Replica::plate, &Plate::end>, "m", length, each, "lowest position"},
    {"plate.speed", replica<&Replica::plate, &Plate::speed>, "m/s", above_zero_to(1000), each, "maximum speed; protocol.rate_tolerance may reduce it"},

    {"protocol.cycles", replica<&Replica::protocol, &Protocol::cycles>, "", between(1, 10000), each, "strokes down to plate.end and back"},
    {"protocol.discard", replica<&Replica::protocol, &Protocol::discard>, "", between(0, 9999), each, "number of first cycles that metrics ignore"},
    {"protocol.scans_per_stroke", replica<&Replica::protocol, &Protocol::scans_per_stroke>, "", between(1, 10000), each, "equally spaced plate positions at which everything is recorded, the last at the stroke's end"},
    {"protocol.stop_at_scans", replica<&Replica::protocol, &Protocol::stop_at_scans>, "", none, each, "true: the plate waits at each scan until the packing settles, which shakes it; false: scans are recorded without stopping"},
    {"protocol.rate_tolerance", replica<&Replica::protocol, &Protocol::rate_tolerance>, "", between(0, 1), each, "maximum estimated relative error, caused by the plate's speed, of forces averaged over packings (ten times the inertial number); single scans differ more: the plate is slow at small loads; 0: always plate.speed"},
    {"protocol.settle_unbalanced_force", replica<&Replica::protocol, &Protocol::settle_unbalanced_force>, "", above_zero_to(1), each, "the packing counts as settled below this ratio of the net force on a grain to the pressure on its cross-section (root mean square)"},
    {"protocol.settle_time", replica<&Replica::protocol, &Protocol::settle_time>, "s", duration, each, "maximum wait; a scan taken then is marked as unsettled. Default: 0.5 s, or 1000 Rayleigh times of the smallest grain (pi R / speed of Rayleigh waves), if these are shorter"},
    {"protocol.settle_drag", replica<&Replica::protocol, &Protocol::settle_drag>, "1/s", between(0, 1e6), each, "drag on velocities and spins while the plate stands still, in addition to grains.drag; a step removes at most half of a velocity"},
    {"protocol.pause", replica<&Replica::protocol, &Protocol::pause>, "s", between(0, 1e6), each, "above 0: at each scan the plate stands for this time without any settling, as in an experiment that pauses for a scan; between scans its velocity is half a sine with the mean plate.speed; needs stop_at_scans"},
    {"protocol.hold", replica<&Replica::protocol, &Protocol::hold>, "s", between(0, 1e6), each, "above 0: the plate stands at plate.end for this time before it goes back, without any settling; the scan there is taken at the end"},
    {"protocol.relax_time", replica<&Replica::protocol, &Protocol::relax_time>, "s", between(0, 1e6), each, "maximum relaxation time before the first stroke, with the plate at plate.start; 0: none, and initial velocities are kept. Default: 1 s, or 2000 Rayleigh times of the smallest grain, if these are shorter"},
    {"protocol.scan_at_start", replica<&Replica::protocol, &Protocol::scan_at_start>, "", none, each, "record a scan (frame 0) of the relaxed packing before the first stroke; needed as the start of an experiment made from the run"},
    {"protocol.force_threshold", replica<&Replica::protocol, &Protocol::force_threshold>, "N", between(0, 1e9), each, "contacts with smaller forces are ignored in Z and in the mean force"},

    {"numerics.time_step", replica<&Replica::numerics, &Numerics::time_step>, "", above_zero_to(1), each, "maximum time step over the Rayleigh time of the smallest grain; elastic_sphere and hyperelastic_sphere use shorter steps when contacts stiffen"},
    {"numerics.skin", replica<&Replica::numerics, &Numerics::skin>, "", above_zero_to(2), each, "margin of the neighbour list over the mean radius"},
    {"numerics.probe_gap", replica<&Replica::numerics, &Numerics::probe_gap>, "", between(0, 2), each, "maximum gap, over the mean radius, at which surface displacements can create contacts"},
    {"numerics.overlap_limit", replica<&Replica::numerics, &Numerics::overlap_limit>, "", above_zero_to(1), each, "corrected overlap beyond which the replica stops, because no static solution is assumed to exist; over the sum of the radii, and times the ratio of the larger radius to the smaller one; on a wall over the radius"},
    {"numerics.stop_beyond_law", replica<&Replica::numerics, &Numerics::stop_beyond_law>, "", none, each, "a replica stops at the first scan with overlaps beyond the range in which its contact model was compared with finite elements (elastic_sphere 0.1, hyperelastic_sphere 0.2, measured as for overlap_limit); false: it continues, and `mcdem table` reports it"},
    {"numerics.precision", run<&Scene::precision>, "", none, one_run, "floating-point precision on the device"},
    {"numerics.slots", run<&Scene::slots>, "", Range{0, 64, Range::Low::included, 16}, one_run, "maximum number of near neighbours of a grain, walls included; 0: the smallest of 16, 32, 48 and 64 that suffices for the sizes, or for the packing file. It does not affect results"},

    {"effects.adhesion", effect<&Effects::adhesion>, "J/m2", between(0, 1000), each, "work of adhesion w, between grains and on walls: contacts attract with 2 pi w R* (DMT)"},
    {"effects.cohesion", effect<&Effects::cohesion>, "J/m3", between(0, 1e9), each, "k: grains and walls that overlap by delta attract with k times the area 2 pi R* delta of their intersection (SJKR)"},
    {"effects.net_force_friction", effect<&Effects::net_force_friction>, "", between(0, 1), each, "fraction s of the attraction A that reduces the Coulomb limit mu abs(F - s A), with F the repulsion; 0: the limit of grains without attraction; 1: that of the net force"},
    {"effects.viscoelasticity", effect<&Effects::viscoelasticity>, "", between(0, 1), each, "fraction of a contact's force that relaxes at constant overlap"},
    {"effects.relaxation_time", effect<&Effects::relaxation_time>, "s", duration, each, "relaxation time of that fraction"},
    {"effects.stiffening", effect<&Effects::stiffening>, "", between(-100, 100), each, "c: the Hertz force is multiplied by 1 + c overlap / R*; for c < 0 (softening) it is divided by 1 - c overlap / R*"},
    {"effects.law_exponent", effect<&Effects::law_exponent>, "", between(-0.5, 2), each, "m: the Hertz force is multiplied by (overlap / (0.1 R*))^m, so that it grows with the power 3/2 + m of the overlap"},
    {"effects.finite_strain", effect<&Effects::finite_strain>, "", between(0, 1), each, "elastic_sphere: fraction of its difference to hyperelastic_sphere that is added; 1: hyperelastic_sphere; other models ignore it"},
    {"effects.plasticity", effect<&Effects::plasticity>, "", between(0, 0.99), each, "fraction of the deepest overlap that remains after unloading"},
    {"effects.bulge_contacts", effect<&Effects::bulge_contacts>, "", between(0, 1), each, "fraction of the surface displacement that counts where the undeformed grains do not overlap; 1: all of it; 0: surface displacements create no contacts"},
    {"effects.friction_history", effect<&Effects::friction_history>, "", between(0, 1), each, "weight of another friction law: of saturated friction if contact.friction_law is a spring, of mindlin if it is saturated"},
    {"effects.rolling_resistance", effect<&Effects::rolling_resistance>, "", between(0, 10), each, "mu_r: a rolling spring that yields at the torque mu_r R* F_n"},
    {"effects.modulus_scatter", effect<&Effects::modulus_scatter>, "", between(0, 2), each, "standard deviation of ln E between grains; the mean of E does not change"},
    {"effects.diameter_error", effect<&Effects::diameter_error>, "m", between(-10, 10), each, "true minus stated diameter, the same for all grains; results contain the stated diameter"},
    {"effects.polydispersity", effect<&Effects::polydispersity>, "m", between(0, 10), each, "standard deviation of true minus stated diameter, drawn for each grain"},
    {"effects.width_error_x", effect<&Effects::width_error_x>, "m", between(-10, 10), each, "true minus stated width of a box or cylinder along x: the wall at the larger x is farther outside; results contain the stated width"},
    {"effects.width_error_y", effect<&Effects::width_error_y>, "m", between(-10, 10), each, "the same along y; a cylinder is as wide as along x"},
    {"effects.plate_tilt_x", effect<&Effects::plate_tilt_x>, "", between(-1, 1), each, "slope of the plate along x, around the centre of the box"},
    {"effects.plate_tilt_y", effect<&Effects::plate_tilt_y>, "", between(-1, 1), each, "slope of the plate along y"},
    {"effects.plate_compliance", effect<&Effects::plate_compliance>, "m/N", between(0, 1e6), each, "displacement of the plate per newton of load; results contain the commanded position"},

    {"output.positions", run<&Scene::output, &Output::positions>, "", none, one_run, "record the position of every grain at scans"},
    {"output.contacts", run<&Scene::output, &Output::contacts>, "", none, one_run, "record the force of every contact at scans"},
    {"output.checkpoint_minutes", run<&Scene::output, &Output::checkpoint_minutes>, "min", above_zero_to(1e5), one_run, "wall-clock time between checkpoints; at least 20 times the time that writing one takes, if this is more than a second"},

    {"batch.replicas", &follow<&Settings::copies>, "", between(1, 10000), one_run, "number of copies of every setting, each with its own packing seed"},
};
// clang-format on

}  // namespace

bool Range::contains(double value) const {
    if (value < low || (value == low && low_end == Low::excluded)) return false;
    return value <= high && (multiple_of == 1 || static_cast<long>(value) % multiple_of == 0);
}

std::span<const Key> keys() { return table; }

const Key* find_key(std::string_view name) {
    const auto found = std::ranges::find(table, name, &Key::name);
    if (found != std::end(table)) return found;
    const auto element = list_element(name);
    if (!element) return nullptr;
    const auto of_element = std::ranges::find(element->keys(), name, &Key::name);
    return of_element == element->keys().end() ? nullptr : &*of_element;
}

bool is_table(std::string_view name) {
    constexpr std::string_view vary = "batch.vary";
    if (name == vary) return true;
    if (name.starts_with(vary) && name.size() > vary.size() && name[vary.size()] == '.')
        name.remove_prefix(vary.size() + 1);
    if (find_list_table(name) || (list_element(name) && name.find('.') == name.rfind('.'))) return true;
    return std::ranges::any_of(table, [&](const Key& key) {
        return key.name.size() > name.size() && key.name.starts_with(name) && key.name[name.size()] == '.';
    });
}

const Key* same_key(std::string_view name) {
    if (name == "box.size_x") return find_key("container.size_x");
    if (name == "box.size_y") return find_key("container.size_y");
    if (name == "container.size_x") return find_key("box.size_x");
    return name == "container.size_y" ? find_key("box.size_y") : nullptr;
}

bool is_key_of(ContainerShape shape, std::string_view name) {
    if (name == "container.radius") return shape == ContainerShape::cylinder;
    if (name == "container.height") return shape == ContainerShape::cell;
    if (name.starts_with("plate.") || name.starts_with("walls.") || name.starts_with("effects.plate_") ||
        name == "grains.excess_density")
        return shape != ContainerShape::cell;
    return !same_key(name) || shape != ContainerShape::cylinder;
}

bool is_generator_key(std::string_view name) {
    if (const auto element = list_element(name); element && element->table->name == "species")
        return name.ends_with(".sizes") || name.find(".diameter_") != name.npos;
    return name == "packing.count" || name == "packing.packing_fraction" ||
           name.starts_with("packing.diameter_");
}

}  // namespace mcdem::scene
