#include "scene/keys.h"

#include <algorithm>

#include "scene/key_rows.h"
#include "scene/list_tables.h"

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
    {"name", run<&Scene::name>, "", none, one_run, "what the run is called; without it, the file's name"},

    {"container.shape", replica<&Replica::box, &Box::shape>, "", none, each, "what holds the grains at the sides, between floor and plate. box: four walls; cylinder: one upright wall, its axis at x = y = radius; periodic: no walls, the packing repeats along x and y; cell: neither walls nor floor nor plate nor weight, the packing repeats along x, y and z, and a programme deforms it"},
    {"container.size_x", replica<&Replica::box, &Box::size_x>, "m", length, each, "of a box: distance of the walls x_min and x_max; of periodic and cell: the length along x after which the packing repeats"},
    {"container.size_y", replica<&Replica::box, &Box::size_y>, "m", length, each, "along y; the floor is at z = 0"},
    {"container.radius", &follow<&Settings::cylinder_radius>, "m", length, each, "of a cylinder"},
    {"container.height", &follow<&Settings::cell_height>, "m", length, each, "of a cell whose packing is a file: its length along z. That of a generated packing follows from packing.count and packing.packing_fraction"},

    {"box.size_x", replica<&Replica::box, &Box::size_x>, "m", length, each, "short for container.size_x"},
    {"box.size_y", replica<&Replica::box, &Box::size_y>, "m", length, each, "short for container.size_y"},

    {"grains.youngs_modulus", replica<&Replica::grains, &GrainMaterial::youngs_modulus>, "Pa", stiffness, each, "E"},
    {"grains.poisson_ratio", replica<&Replica::grains, &GrainMaterial::poisson_ratio>, "", poisson, each, "nu"},
    {"grains.density", replica<&Replica::grains, &GrainMaterial::density>, "kg/m3", mass_density, each, "gives the inertia; quasi-static results do not depend on it, the time step does"},
    {"grains.excess_density", replica<&Replica::grains, &GrainMaterial::excess_density>, "kg/m3", between(-1e5, 1e5), each, "over the fluid's, gives the weight; 0: weightless"},
    {"grains.friction", replica<&Replica::grains, &GrainMaterial::friction>, "", friction, each, "mu, grain on grain"},
    {"grains.restitution", replica<&Replica::grains, &GrainMaterial::restitution>, "", bounce, each, "e, grain on grain: rebound over approach speed of a lone pair"},
    {"grains.drag", replica<&Replica::grains, &GrainMaterial::drag>, "1/s", between(0, 1e6), each, "background drag, force = -drag * mass * velocity"},

    {"walls.youngs_modulus", replica<&Replica::walls, &WallMaterial::youngs_modulus>, "Pa", stiffness, each, "E of all walls and the plate"},
    {"walls.poisson_ratio", replica<&Replica::walls, &WallMaterial::poisson_ratio>, "", poisson, each, "nu"},
    {"walls.friction", replica<&Replica::walls, &WallMaterial::friction>, "", friction, each, "mu, grain on wall"},
    {"walls.restitution", replica<&Replica::walls, &WallMaterial::restitution>, "", bounce, each, "e, grain on wall"},

    {"contact.model", replica<&Replica::contact, &ContactLaw::model>, "", none, each, "how the contacts of one grain feel one another"},
    {"contact.gamma", replica<&Replica::contact, &ContactLaw::gamma>, "", between(0, 10), each, "prefactor of the surface displacements of mc_dem; other models do not use it"},
    {"contact.friction_law", replica<&Replica::contact, &ContactLaw::friction_law>, "", none, each, "saturated: always mu times the normal force, against sliding; mindlin: a spring with history, cut there"},
    {"contact.sliding_velocity", replica<&Replica::contact, &ContactLaw::sliding_velocity>, "m/s", above_zero_to(100), each, "below it saturated friction fades to zero"},

    {"packing.file", &follow<&Settings::packing_file>, "", none, each, "LIGGGHTS/LAMMPS data file or text dump, Yade's text (x y z r), run.h5, or .csv with columns x_m,y_m,z_m,diameter_m, such as an experiment's grains.csv; a column species or type says which [[species]] a grain is, by name or by number from 1; relative to the scene file (in --set: to the current folder). Without it the packing is generated"},
    {"packing.frame", &follow<&Settings::packing_frame>, "", between(-1, 2e9), each, "timestep of the dump that packing.file names, or frame of a grains.csv or run.h5; -1: the last of a dump, the first of the others"},
    {"packing.count", generated<&GeneratedPacking::count>, "", between(1, 1e7), each, "grains generated"},
    {"packing.diameter_mean", generated<&GeneratedPacking::diameter_mean>, "m", grain_size, each, "of a normal distribution"},
    {"packing.diameter_sd", generated<&GeneratedPacking::diameter_sd>, "m", between(0, 10), each, "its standard deviation"},
    {"packing.diameter_min", generated<&GeneratedPacking::diameter_min>, "m", grain_size, each, "where it is cut below"},
    {"packing.diameter_max", generated<&GeneratedPacking::diameter_max>, "m", grain_size, each, "where it is cut above"},
    {"packing.packing_fraction", generated<&GeneratedPacking::packing_fraction>, "", between(0.01, 0.75), each, "grains' volume over the box's volume up to the height that is filled"},
    {"packing.position_jitter", replica<&Replica::packing, &PackingSource::position_jitter>, "m", between(0, 10), each, "standard deviation of a random displacement of every coordinate"},
    {"packing.fractions_by", replica<&Replica::packing, &PackingSource::fractions_by>, "", none, each, "what the fractions of [[species]] are shares of: the number of the grains or their volume"},
    {"packing.seed", replica<&Replica::packing, &PackingSource::seed>, "", between(0, 1e15), each, "of generation, jitter and which grain is of which species; copy n has seed + n - 1"},

    {"plate.start", replica<&Replica::plate, &Plate::start>, "m", length, each, "highest position of its lower face"},
    {"plate.end", replica<&Replica::plate, &Plate::end>, "m", length, each, "lowest position"},
    {"plate.speed", replica<&Replica::plate, &Plate::speed>, "m/s", above_zero_to(1000), each, "at most; protocol.rate_tolerance may ask for less"},

    {"protocol.cycles", replica<&Replica::protocol, &Protocol::cycles>, "", between(1, 10000), each, "strokes down to plate.end and back"},
    {"protocol.discard", replica<&Replica::protocol, &Protocol::discard>, "", between(0, 9999), each, "first cycles left out of metrics"},
    {"protocol.scans_per_stroke", replica<&Replica::protocol, &Protocol::scans_per_stroke>, "", between(1, 10000), each, "equally spaced plate positions at which everything is recorded, the last at the stroke's end"},
    {"protocol.stop_at_scans", replica<&Replica::protocol, &Protocol::stop_at_scans>, "", none, each, "the plate waits at each scan until the packing settles; false: recorded in passing"},
    {"protocol.rate_tolerance", replica<&Replica::protocol, &Protocol::rate_tolerance>, "", between(0, 1), each, "largest estimated relative error of forces by the plate's speed, ten times the inertial number: the plate is slow where the load is small; 0: always plate.speed"},
    {"protocol.settle_unbalanced_force", replica<&Replica::protocol, &Protocol::settle_unbalanced_force>, "", above_zero_to(1), each, "net force on a grain over the pressure on its cross-section, root mean square, below which the packing counts as settled"},
    {"protocol.settle_time", replica<&Replica::protocol, &Protocol::settle_time>, "s", duration, each, "longest wait; a scan taken then is marked unsettled"},
    {"protocol.settle_drag", replica<&Replica::protocol, &Protocol::settle_drag>, "1/s", between(0, 1e6), each, "drag of velocities and spins while the plate stands still, on top of grains.drag; at most half of a velocity is taken away in a step"},
    {"protocol.relax_time", replica<&Replica::protocol, &Protocol::relax_time>, "s", between(0, 1e6), each, "longest relaxation before the first stroke, the plate at plate.start"},
    {"protocol.scan_at_start", replica<&Replica::protocol, &Protocol::scan_at_start>, "", none, each, "a scan, frame 0, of the relaxed packing before the first stroke: an experiment made from the run starts there"},
    {"protocol.force_threshold", replica<&Replica::protocol, &Protocol::force_threshold>, "N", between(0, 1e9), each, "contacts below it do not count in Z and the mean force"},

    {"numerics.time_step", replica<&Replica::numerics, &Numerics::time_step>, "", above_zero_to(1), each, "at most, a fraction of the Rayleigh time of the smallest grain; steps of elastic_sphere and hyperelastic_sphere are shorter where contacts have stiffened"},
    {"numerics.skin", replica<&Replica::numerics, &Numerics::skin>, "", above_zero_to(2), each, "margin of the neighbour list, over the mean radius"},
    {"numerics.probe_gap", replica<&Replica::numerics, &Numerics::probe_gap>, "", between(0, 2), each, "gap up to which surfaces are probed for contacts made by bulging, over the mean radius"},
    {"numerics.overlap_limit", replica<&Replica::numerics, &Numerics::overlap_limit>, "", above_zero_to(1), each, "corrected overlap over the sum of radii beyond which no static solution is assumed and the replica stops"},
    {"numerics.stop_beyond_law", replica<&Replica::numerics, &Numerics::stop_beyond_law>, "", none, each, "a replica stops at the first scan in which grains overlap more than its contact model was tested for against finite elements: elastic_sphere 0.1, hyperelastic_sphere 0.2 of the sum of radii; false: it goes on, and `mcdem table` says so"},
    {"numerics.precision", run<&Scene::precision>, "", none, one_run, "of the device's arithmetic"},
    {"numerics.slots", run<&Scene::slots>, "", Range{16, 64, Range::Low::included, 16}, one_run, "neighbours that a grain can have"},

    {"effects.adhesion", effect<&Effects::adhesion>, "J/m2", between(0, 1000), each, "work of adhesion w of two grains, and of a grain and a wall: touching contacts attract by 2 pi w R* (DMT)"},
    {"effects.viscoelasticity", effect<&Effects::viscoelasticity>, "", between(0, 1), each, "part of a contact's force that relaxes at constant overlap"},
    {"effects.relaxation_time", effect<&Effects::relaxation_time>, "s", duration, each, "of that part"},
    {"effects.stiffening", effect<&Effects::stiffening>, "", between(-100, 100), each, "c: Hertz force times 1 + c overlap / R*; where c < 0 over 1 - c overlap / R*, which softens"},
    {"effects.finite_strain", effect<&Effects::finite_strain>, "", between(0, 1), each, "elastic_sphere: share of what finite strain adds to it, 1: hyperelastic_sphere; unused by other models"},
    {"effects.plasticity", effect<&Effects::plasticity>, "", between(0, 0.99), each, "part of the deepest overlap that stays after unloading"},
    {"effects.bulge_contacts", effect<&Effects::bulge_contacts>, "", between(0, 1), each, "part of the bulges that counts where grains do not overlap by themselves; 1: all of it, 0: bulges make no contacts"},
    {"effects.friction_history", effect<&Effects::friction_history>, "", between(0, 1), each, "share of the friction law that contact.friction_law does not name"},
    {"effects.rolling_resistance", effect<&Effects::rolling_resistance>, "", between(0, 10), each, "mu_r: couple of mu_r R* F_n against rolling and twisting"},
    {"effects.modulus_scatter", effect<&Effects::modulus_scatter>, "", between(0, 2), each, "standard deviation of ln E from grain to grain; the mean of E stays"},
    {"effects.diameter_error", effect<&Effects::diameter_error>, "m", between(-10, 10), each, "true less stated diameter, all grains alike; results state the stated one"},
    {"effects.polydispersity", effect<&Effects::polydispersity>, "m", between(0, 10), each, "standard deviation of true less stated diameter, grain by grain"},
    {"effects.plate_tilt_x", effect<&Effects::plate_tilt_x>, "", between(-1, 1), each, "slope of the plate along x, about the middle of the box"},
    {"effects.plate_tilt_y", effect<&Effects::plate_tilt_y>, "", between(-1, 1), each, "slope of the plate along y"},
    {"effects.plate_compliance", effect<&Effects::plate_compliance>, "m/N", between(0, 1e6), each, "how far the plate gives way per newton on it; results state the position that it was sent to"},

    {"output.positions", run<&Scene::output, &Output::positions>, "", none, one_run, "record every grain's position at scans"},
    {"output.contacts", run<&Scene::output, &Output::contacts>, "", none, one_run, "record every contact's force at scans"},
    {"output.checkpoint_minutes", run<&Scene::output, &Output::checkpoint_minutes>, "min", above_zero_to(1e5), one_run, "time on the clock between checkpoints"},

    {"batch.replicas", &follow<&Settings::copies>, "", between(1, 10000), one_run, "copies of every setting, each with its own packing seed"},
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
