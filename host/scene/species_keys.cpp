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
    {"fraction", of_species<&Species::fraction>, "", between(0, 1), each, "fraction of the grains, in the measure packing.fractions_by; species without it share the rest equally"},
    {"youngs_modulus", of_material<&GrainMaterial::youngs_modulus>, "Pa", above_zero_to(1e13), each, "E; material keys that a species omits are taken from [grains]"},
    {"poisson_ratio", of_material<&GrainMaterial::poisson_ratio>, "", between(0, 0.5), each, "nu"},
    {"density", of_material<&GrainMaterial::density>, "kg/m3", above_zero_to(1e5), each, "mass density"},
    {"excess_density", of_material<&GrainMaterial::excess_density>, "kg/m3", between(-1e5, 1e5), each, "density minus that of the fluid; determines the weight"},
    {"friction", of_material<&GrainMaterial::friction>, "", between(0, 10), each, "mu between grains of this species; between two species the smaller value, unless a [[pair]] sets it"},
    {"restitution", of_material<&GrainMaterial::restitution>, "", above_zero_to(1), each, "e, by the same rule"},
    {"sizes", of_sizes<&Sizes::law>, "", none, one_run, "size distribution of generated grains. normal, lognormal: truncated at diameter_min and diameter_max; single: all diameters equal diameter_mean; table: drawn from diameter_file with equal probability"},
    {"diameter_mean", of_sizes<&Sizes::mean>, "m", grain_size, each, "mean before truncation; default: that of [packing]"},
    {"diameter_sd", of_sizes<&Sizes::sd>, "m", between(0, 10), each, "standard deviation of the diameter (not of its logarithm) before truncation; default: that of [packing]"},
    {"diameter_min", of_sizes<&Sizes::min>, "m", grain_size, each, "lower limit of truncation; default: three standard deviations (lognormal: of the logarithm) below the mean, or that of [packing] if the species sets neither mean nor standard deviation"},
    {"diameter_max", of_sizes<&Sizes::max>, "m", grain_size, each, "upper limit of truncation, by the same rule"},
    {"diameter_file", of_sizes<&Sizes::file>, "", none, each, "CSV file with a column diameter_m; path relative to the scene file (in --set: to the current folder)"},
};

const Key pair_rows[] = {
    {"first", of_pair<&SpeciesPair::first>, "", none, one_run, "name of a species"},
    {"second", of_pair<&SpeciesPair::second>, "", none, one_run, "name of another species, or `walls` for floor, plate and sides"},
    {"friction", of_pair<&SpeciesPair::friction>, "", between(0, 10), each, "mu between the two; default: the smaller of their values, on walls that of [walls]"},
    {"restitution", of_pair<&SpeciesPair::restitution>, "", above_zero_to(1), each, "e between the two, by the same rule"},
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
