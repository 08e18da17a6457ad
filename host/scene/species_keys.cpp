// The keys of [[species]] and [[pair]]: the same rows for each.
#include "scene/key_rows.h"
#include "scene/list_tables.h"

namespace mcdem::inline scene {
namespace {

using namespace rows;

template <auto member>
auto& of_species(Settings& settings, std::size_t n) {
    return element(settings.replica.species, n).*member;
}
template <auto member>
auto& of_material(Settings& settings, std::size_t n) {
    return of_species<&Species::material>(settings, n).*member;
}
template <auto member>
auto& of_sizes(Settings& settings, std::size_t n) {
    return of_species<&Species::sizes>(settings, n).*member;
}
template <auto member>
auto& of_pair(Settings& settings, std::size_t n) {
    return element(settings.replica.pairs, n).*member;
}

// clang-format off
const Key species_rows[] = {
    {"name", of_species<&Species::name>, "", none, one_run, "what results and [[pair]] call it"},
    {"fraction", of_species<&Species::fraction>, "", between(0, 1), each, "of the grains, by packing.fractions_by; those left out share what the others leave"},
    {"youngs_modulus", of_material<&GrainMaterial::youngs_modulus>, "Pa", above_zero_to(1e13), each, "E; what is left out of a species' material is that of [grains]"},
    {"poisson_ratio", of_material<&GrainMaterial::poisson_ratio>, "", between(0, 0.5), each, "nu"},
    {"density", of_material<&GrainMaterial::density>, "kg/m3", above_zero_to(1e5), each, "gives the inertia"},
    {"excess_density", of_material<&GrainMaterial::excess_density>, "kg/m3", between(-1e5, 1e5), each, "over the fluid's, gives the weight"},
    {"friction", of_material<&GrainMaterial::friction>, "", between(0, 10), each, "mu of two grains of this species; of two species the smaller of theirs, unless a [[pair]] says it"},
    {"restitution", of_material<&GrainMaterial::restitution>, "", above_zero_to(1), each, "e, likewise"},
    {"sizes", of_sizes<&Sizes::law>, "", none, one_run, "of generated grains. normal, lognormal: cut at diameter_min and diameter_max; single: all of diameter_mean; table: each diameter of diameter_file as likely"},
    {"diameter_mean", of_sizes<&Sizes::mean>, "m", grain_size, each, "before the cut; without it that of [packing]"},
    {"diameter_sd", of_sizes<&Sizes::sd>, "m", between(0, 10), each, "standard deviation before the cut, of the diameter itself; without it that of [packing]"},
    {"diameter_min", of_sizes<&Sizes::min>, "m", grain_size, each, "where it is cut below; without it three standard deviations (lognormal: of the logarithm) from the mean, or that of [packing] where the species has neither mean nor standard deviation of its own"},
    {"diameter_max", of_sizes<&Sizes::max>, "m", grain_size, each, "where it is cut above, likewise"},
    {"diameter_file", of_sizes<&Sizes::file>, "", none, each, "CSV with a column diameter_m; relative to the scene file (in --set: to the current folder)"},
};

const Key pair_rows[] = {
    {"first", of_pair<&SpeciesPair::first>, "", none, one_run, "name of a species"},
    {"second", of_pair<&SpeciesPair::second>, "", none, one_run, "name of another, or walls: floor, plate and sides"},
    {"friction", of_pair<&SpeciesPair::friction>, "", between(0, 10), each, "mu of the two; without it the smaller of theirs, on walls that of [walls]"},
    {"restitution", of_pair<&SpeciesPair::restitution>, "", above_zero_to(1), each, "e of the two, likewise"},
};
// clang-format on

}  // namespace

std::span<const Key> species_keys(int number) {
    static const ListKeys all("species", max_species, species_rows);
    return all.of(number);
}

std::span<const Key> pair_keys(int number) {
    static const ListKeys all("pair", max_pairs, pair_rows);
    return all.of(number);
}

}  // namespace mcdem::scene
