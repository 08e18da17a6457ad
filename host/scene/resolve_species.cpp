#include "scene/resolve_species.h"

#include <algorithm>
#include <cmath>

#include "core/errors.h"
#include "scene/sizes.h"

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

}  // namespace mcdem::scene
