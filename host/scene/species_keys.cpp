// The keys of [[species]] and [[pair]]: the same rows for each.
#include "scene/list_tables.h"

namespace mcdem::inline scene {
namespace {

template <std::size_t n, auto member>
auto& of_species(Settings& settings) {
    return element(settings.replica.species, n).*member;
}
template <std::size_t n, auto member>
auto& of_material(Settings& settings) {
    return of_species<n, &Species::material>(settings).*member;
}
template <std::size_t n, auto member>
auto& of_sizes(Settings& settings) {
    return of_species<n, &Species::sizes>(settings).*member;
}
template <std::size_t n, auto member>
auto& of_pair(Settings& settings) {
    return element(settings.replica.pairs, n).*member;
}

constexpr Range positive(double high) { return {0, high, Range::Low::excluded}; }
constexpr Range between(double low, double high) { return {low, high}; }
constexpr Range none{}, size = {1e-7, 10};
constexpr Scope one_run = Scope::run, each = Scope::replica;

// clang-format off
struct SpeciesRows {
    template <std::size_t n>
    static std::vector<Key> of() {
        return {
            {"name", of_species<n, &Species::name>, "", none, one_run, "what results and [[pair]] call it"},
            {"fraction", of_species<n, &Species::fraction>, "", between(0, 1), each, "of the grains, by packing.fractions_by; those left out share what the others leave"},
            {"youngs_modulus", of_material<n, &GrainMaterial::youngs_modulus>, "Pa", positive(1e13), each, "E; what is left out of a species' material is that of [grains]"},
            {"poisson_ratio", of_material<n, &GrainMaterial::poisson_ratio>, "", between(0, 0.5), each, "nu"},
            {"density", of_material<n, &GrainMaterial::density>, "kg/m3", positive(1e5), each, "gives the inertia"},
            {"excess_density", of_material<n, &GrainMaterial::excess_density>, "kg/m3", between(-1e5, 1e5), each, "over the fluid's, gives the weight"},
            {"friction", of_material<n, &GrainMaterial::friction>, "", between(0, 10), each, "mu of two grains of this species; of two species the smaller of theirs, unless a [[pair]] says it"},
            {"restitution", of_material<n, &GrainMaterial::restitution>, "", positive(1), each, "e, likewise"},
            {"sizes", of_sizes<n, &Sizes::law>, "", none, one_run, "of generated grains. normal, lognormal: cut at diameter_min and diameter_max; single: all of diameter_mean; table: each diameter of diameter_file as likely"},
            {"diameter_mean", of_sizes<n, &Sizes::mean>, "m", size, each, "before the cut; without it that of [packing]"},
            {"diameter_sd", of_sizes<n, &Sizes::sd>, "m", between(0, 10), each, "standard deviation before the cut, of the diameter itself; without it that of [packing]"},
            {"diameter_min", of_sizes<n, &Sizes::min>, "m", size, each, "where it is cut below; without it three standard deviations (lognormal: of the logarithm) from the mean, or that of [packing] where the species has neither mean nor standard deviation of its own"},
            {"diameter_max", of_sizes<n, &Sizes::max>, "m", size, each, "where it is cut above, likewise"},
            {"diameter_file", of_sizes<n, &Sizes::file>, "", none, each, "CSV with a column diameter_m; relative to the scene file (in --set: to the current folder)"},
        };
    }
};

struct PairRows {
    template <std::size_t n>
    static std::vector<Key> of() {
        return {
            {"first", of_pair<n, &SpeciesPair::first>, "", none, one_run, "name of a species"},
            {"second", of_pair<n, &SpeciesPair::second>, "", none, one_run, "name of another, or walls: floor, plate and sides"},
            {"friction", of_pair<n, &SpeciesPair::friction>, "", between(0, 10), each, "mu of the two; without it the smaller of theirs, on walls that of [walls]"},
            {"restitution", of_pair<n, &SpeciesPair::restitution>, "", positive(1), each, "e of the two, likewise"},
        };
    }
};
// clang-format on

}  // namespace

std::span<const Key> species_keys(int number) {
    static const ListKeys<SpeciesRows, max_species> all("species");
    return all.of(number);
}

std::span<const Key> pair_keys(int number) {
    static const ListKeys<PairRows, max_pairs> all("pair");
    return all.of(number);
}

}  // namespace mcdem::scene
