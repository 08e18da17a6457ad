#include "scene/read/list_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <deque>

#include "scene/read/key_rows.h"

namespace mcdem::inline scene {
namespace {

using namespace rows;

/// The rows of a key table repeated for every element, with full names.
class ListKeys {
public:
    ListKeys(std::string_view table, int most, std::span<const Key> rows) {
        for (std::size_t n = 0; n < static_cast<std::size_t>(most); ++n) {
            std::vector<Key>& keys = keys_.emplace_back(rows.begin(), rows.end());
            for (Key& key : keys) {
                key.name = names_.emplace_back(fmt::format("{}.{}.{}", table, n + 1, key.name));
                std::visit([&](auto& member) { member.element = n; }, key.member);
            }
        }
    }
    std::span<const Key> of(int element) const { return keys_[element]; }

private:
    std::vector<std::vector<Key>> keys_;
    std::deque<std::string> names_;
};

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

template <auto member>
auto& of_stage(Settings& settings, std::size_t n) {
    return element(settings.replica.programme, n).*member;
}

constexpr Range compression{-10, 0.99, Range::Low::included}, shear{-5, 5, Range::Low::included},
    shear_stress{-1e13, 1e13, Range::Low::included};

// clang-format off
const Key species_rows[] = {
    {"name", of_species<&Species::name>, "", none, one_run, "name used in results and [[pair]]"},
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
const Key stage_rows[] = {
    {"stage", of_stage<&Stage::kind>, "", none, one_run, "move: to a position, strain or force; hold: keep one for a time; cycle: move there and back; repeat: earlier stages. A cell moves to strains and stresses, holds and repeats"},
    {"position", of_stage<&Stage::position>, "m", above_zero_to(1000), each, "target of a move, or turning point of a cycle: position of the plate's lower face, from plate.end to plate.start"},
    {"strain", of_stage<&Stage::strain>, "", {0, 1, Range::Low::included}, each, "the same as a strain of the initial height: plate.start (1 - strain); cell: equal strain of its three lengths"},
    {"force", of_stage<&Stage::force>, "N", above_zero_to(1e9), each, "the same as a force on the plate, reached within 0.1 % from the side from which the plate comes"},
    {"strain_x", of_stage<&Stage::strain_x>, "", compression, each, "cell: target of a move, as a compression relative to the initial length; strains that a move does not name do not change"},
    {"strain_y", of_stage<&Stage::strain_y>, "", compression, each, "along y"},
    {"strain_z", of_stage<&Stage::strain_z>, "", compression, each, "along z"},
    {"shear_xy", of_stage<&Stage::shear_xy>, "", shear, each, "cell: displacement of planes y = const. along x, over their initial distance"},
    {"shear_xz", of_stage<&Stage::shear_xz>, "", shear, each, "planes z = const. along x"},
    {"shear_yz", of_stage<&Stage::shear_yz>, "", shear, each, "planes z = const. along y"},
    {"pressure", of_stage<&Stage::pressure>, "Pa", above_zero_to(1e13), each, "cell: target of a move, the same stress along x, y and z, reached within 0.1 %; compression positive"},
    {"stress_x", of_stage<&Stage::stress_x>, "Pa", above_zero_to(1e13), each, "cell: target stress along x, instead of a strain along x; strains of the same move wait until it is reached, and it is kept while they change"},
    {"stress_y", of_stage<&Stage::stress_y>, "Pa", above_zero_to(1e13), each, "along y"},
    {"stress_z", of_stage<&Stage::stress_z>, "Pa", above_zero_to(1e13), each, "along z"},
    {"stress_xy", of_stage<&Stage::stress_xy>, "Pa", shear_stress, each, "cell: target shear stress, instead of shear_xy, reached within 0.1 %; a positive shear needs a negative shear stress. It waits until the stresses of the same move along x, y and z are reached"},
    {"stress_xz", of_stage<&Stage::stress_xz>, "Pa", shear_stress, each, "instead of shear_xz"},
    {"stress_yz", of_stage<&Stage::stress_yz>, "Pa", shear_stress, each, "instead of shear_yz"},
    {"back", of_stage<&Stage::back>, "", {0, 1e9, Range::Low::included}, each, "point to which a cycle returns, in the same quantity (position, strain or force) as its turning point"},
    {"cycles", of_stage<&Stage::cycles>, "", {1, 10000}, each, "cycle: number of cycles"},
    {"growth", of_stage<&Stage::growth>, "", {-1, 1000, Range::Low::excluded}, each, "cycle: increase of the amplitude from one cycle to the next, over the first amplitude"},
    {"keep", of_stage<&Stage::keep>, "", none, one_run, "hold: what is kept constant: the plate's position or force; for a cell its strains (position), or the stresses that the previous move set (stress). The other quantity is recorded against time"},
    {"time", of_stage<&Stage::time>, "s", above_zero_to(1e6), each, "hold: duration"},
    {"stages", of_stage<&Stage::stages>, "", {1, max_stages}, one_run, "repeat: number of stages before it that are repeated"},
    {"times", of_stage<&Stage::times>, "", {2, 10000}, each, "repeat: how often they run in total"},
    {"speed", of_stage<&Stage::speed>, "m/s", above_zero_to(1000), each, "maximum speed of the plate; default: plate.speed. protocol.rate_tolerance may reduce it"},
    {"rate", of_stage<&Stage::rate>, "1/s", above_zero_to(100), each, "cell: maximum rate of the fastest of its strains and shears. protocol.rate_tolerance may reduce it"},
    {"scans", of_stage<&Stage::scans>, "", {0, 10000}, each, "number of scans, equally spaced, the last at the end. Move, and each stroke of a cycle: spaced in position, strain or force (in stress if a move of a cell sets only stresses); hold: spaced in time"},
    {"scan_at", of_stage<&Stage::scan_at>, "", none, one_run, "instead of scans: a list of positions, strains or forces (the quantity of the move), or of times since the start of a hold. Move of a cell: of the strain, shear or, if it sets only stresses, stress that changes most (see Programmes)"},
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

std::span<const Key> stage_keys(int stage) {
    static const ListKeys all("programme", max_stages, stage_rows);
    return all.of(stage);
}

std::span<const ListTable> list_tables() {
    static const ListTable all[] = {
        {"species", max_species, "species", "what its grains are",
         "name, and its share of the grains, its material or its sizes", species_keys,
         [](const Replica& replica) { return replica.species.size(); }},
        {"pair", max_pairs, "pairs", "how two species meet",
         "first and second, and their friction or restitution", pair_keys,
         [](const Replica& replica) { return replica.pairs.size(); }},
        {"programme", max_stages, "stages", "what the plate does",
         "position, strain or force of a move, or stage = hold, cycle or repeat with their keys", stage_keys,
         [](const Replica& replica) { return replica.programme.size(); }},
    };
    return all;
}

const ListTable* find_list_table(std::string_view name) {
    const auto tables = list_tables();
    const auto found = std::ranges::find(tables, name, &ListTable::name);
    return found == tables.end() ? nullptr : &*found;
}

std::optional<ListElement> list_element(std::string_view name) {
    const auto dot = name.find('.');
    const ListTable* table = find_list_table(name.substr(0, dot));
    if (!table || dot == name.npos) return std::nullopt;
    name = name.substr(dot + 1);
    name = name.substr(0, name.find('.'));
    int number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    const bool plain = error == std::errc{} && end == name.data() + name.size() && name.front() != '0';
    if (!plain || number < 1 || number > table->most) return std::nullopt;
    return ListElement{table, number - 1};
}

int stage_of(std::string_view name) {
    const auto element = list_element(name);
    return element && element->table->name == "programme" ? element->number : -1;
}

}  // namespace mcdem::scene
