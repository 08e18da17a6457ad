#include "scene/read/resolve_species.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/errors.h"
#include "core/random.h"
#include "scene/packing/packing_fields.h"
#include "scene/packing/sizes.h"

namespace mcdem::inline scene {
namespace {

constexpr double cut = 3;  ///< standard deviations from the mean

void fill(double& value, double otherwise) {
    if (std::isnan(value)) value = otherwise;
}

void resolve_material(GrainMaterial& own, const GrainMaterial& grains) {
    for (const auto member :
         {&GrainMaterial::youngs_modulus, &GrainMaterial::poisson_ratio, &GrainMaterial::density,
          &GrainMaterial::excess_density, &GrainMaterial::friction, &GrainMaterial::restitution})
        fill(own.*member, grains.*member);
    own.drag = grains.drag;
}

void resolve_cuts(Sizes& sizes) {
    if (sizes.law == SizeLaw::lognormal) {
        const auto [mean, sd] = log_normal(sizes.mean, sizes.sd);
        fill(sizes.min, std::exp(mean - cut * sd));
        fill(sizes.max, std::exp(mean + cut * sd));
    } else {
        fill(sizes.min, sizes.mean - cut * sizes.sd);
        fill(sizes.max, sizes.mean + cut * sizes.sd);
    }
}

void resolve_sizes(Sizes& sizes, const GeneratedPacking& packing, SizeTables& tables) {
    if (sizes.law == SizeLaw::table) {
        sizes.table = sizes.file.empty() ? nullptr : tables.of(sizes.file);
        if (!sizes.table) return;
        sizes.min = sizes.table->front();
        sizes.max = sizes.table->back();
        sizes.mean = 0;
        for (const double diameter : *sizes.table)
            sizes.mean += diameter / static_cast<double>(sizes.table->size());
        return;
    }
    const bool own = !std::isnan(sizes.mean) || !std::isnan(sizes.sd);
    fill(sizes.mean, packing.diameter_mean);
    if (sizes.law == SizeLaw::single) {
        sizes.sd = 0;
        sizes.min = sizes.max = sizes.mean;
        return;
    }
    fill(sizes.sd, packing.diameter_sd);
    if (own) return resolve_cuts(sizes);
    fill(sizes.min, packing.diameter_min);
    fill(sizes.max, packing.diameter_max);
}

/// Species without a fraction share the remainder equally.
void resolve_fractions(std::vector<Species>& species, bool from_file) {
    double given = 0;
    int missing = 0;
    for (const Species& one : species) {
        if (std::isnan(one.fraction))
            ++missing;
        else
            given += one.fraction;
    }
    if (from_file && missing == static_cast<int>(species.size())) return;
    for (Species& one : species) fill(one.fraction, std::max(0.0, 1 - given) / missing);
}

/// Sets the sizes of all species together.
void resolve_packing(const std::vector<Species>& species, GeneratedPacking& packing) {
    const auto by = [](double Sizes::*member) {
        return [member](const Species& one) { return one.sizes.*member; };
    };
    const double smallest = std::ranges::min(species, {}, by(&Sizes::min)).sizes.min;
    const double largest = std::ranges::max(species, {}, by(&Sizes::max)).sizes.max;
    double mean = 0, all = 0;
    for (const Species& one : species) {
        mean += one.fraction * one.sizes.mean;
        all += one.fraction;
    }
    if (!std::isfinite(smallest + largest + mean) || !(all > 0)) return;
    packing.diameter_min = smallest;
    packing.diameter_max = largest;
    packing.diameter_mean = mean / all;
}

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
            end += replica.species[++species].fraction * all;
        packing.species[i] = species;
        before += weight(i);
    }
}

}  // namespace

std::shared_ptr<const std::vector<double>> SizeTables::of(const std::string& file) {
    const auto [place, is_new] = tables_.try_emplace(file);
    if (is_new) try {
            place->second = std::make_shared<const std::vector<double>>(read_diameters(file));
        } catch (const InputError&) {  // species_problems reads it again and reports the problem
        }
    return place->second;
}

bool has_sizes(const Replica& replica) {
    return std::ranges::all_of(replica.species, [](const Species& one) {
        const bool found = one.sizes.law != SizeLaw::table || one.sizes.table;
        return found && one.sizes.min > 0 && one.sizes.min <= one.sizes.mean &&
               one.sizes.mean <= one.sizes.max && one.fraction >= 0;
    });
}

void resolve_species(Settings& settings, SizeTables& tables) {
    auto& species = settings.replica.species;
    if (species.empty()) return;
    const bool from_file = !settings.packing_file.empty();
    for (Species& one : species) {
        resolve_material(one.material, settings.replica.grains);
        if (!from_file) resolve_sizes(one.sizes, settings.generated, tables);
    }
    resolve_fractions(species, from_file);
    if (!from_file) resolve_packing(species, settings.generated);
}

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
    for (int& species : packing.species) species = places[species];
}

}  // namespace mcdem::scene
