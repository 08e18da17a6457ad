#include "scene/assign_species.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/errors.h"
#include "scene/packing_fields.h"
#include "scene/random.h"

namespace mcdem::inline scene {
namespace {

std::string names_of(const std::vector<Species>& species) {
    std::vector<std::string> names;
    for (std::size_t s = 0; s < species.size(); ++s)
        names.push_back(fmt::format("{} or {}", species[s].name, s + 1));
    return fmt::format("{}", fmt::join(names, ", "));
}

/// Index of the species with this name in a file.
int place_of(const std::string& word, const std::vector<Species>& species, const std::string& source) {
    const auto named = std::ranges::find(species, word, &Species::name);
    if (named != species.end()) return static_cast<int>(named - species.begin());
    const auto number = to_whole_number(word);
    if (number && *number >= 1 && *number <= static_cast<long>(species.size()))
        return static_cast<int>(*number - 1);
    throw InputError(fmt::format("{}: a grain's species must be one of [[species]] ({}), got {}", source,
                                 names_of(species), scene::quoted(word)));
}

bool has_fractions(const Replica& replica) { return !std::isnan(replica.species.front().fraction); }

/// Puts the grains in random order and gives each the species in whose share of the order, by number or by
/// volume, its middle lies.
void draw_species(Packing& packing, const Replica& replica) {
    std::vector<std::size_t> order(packing.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    Random(replica.packing.seed, Stream::species).shuffle(order);
    const auto weight = [&](std::size_t i) {
        return replica.packing.fractions_by == FractionsBy::volume ? std::pow(packing.diameter[i], 3) : 1.0;
    };
    double all = 0;
    for (const std::size_t i : order) all += weight(i);
    packing.species.assign(packing.size(), 0);
    const auto last = static_cast<int>(replica.species.size()) - 1;
    double before = 0, end = replica.species.front().fraction * all;
    int species = 0;
    for (const std::size_t i : order) {
        while (species < last && before + weight(i) / 2 > end)
            end += replica.species[static_cast<std::size_t>(++species)].fraction * all;
        packing.species[i] = species;
        before += weight(i);
    }
}

}  // namespace

void assign_species(Packing& packing, const Replica& replica, const std::string& source) {
    const auto words = std::move(packing.species_names);
    packing.species_names.clear();
    if (replica.species.empty()) return packing.species.clear();
    if (words.size() > 1 && has_fractions(replica))
        throw InputError(
            fmt::format("{}: the fractions of [[species]] must be left out, got some: the file says of "
                        "each grain which species it is",
                        source));
    if (words.size() <= 1 && has_fractions(replica)) return draw_species(packing, replica);
    if (replica.species.size() == 1) return packing.species.assign(packing.size(), 0);
    if (words.empty())
        throw InputError(
            fmt::format("{}: must say of each grain which species it is (a column species or type), or "
                        "[[species]] have fractions, got neither",
                        source));
    std::vector<int> places;
    for (const std::string& word : words) places.push_back(place_of(word, replica.species, source));
    for (int& species : packing.species) species = places[static_cast<std::size_t>(species)];
}

}  // namespace mcdem::scene
