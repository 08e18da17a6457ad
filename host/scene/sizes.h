// Diameters of a species' grains as distributions.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scene/species.h"

namespace mcdem::inline scene {

/// The diameter below which a share in (0, 1) of the grains lies [m].
double quantile(const Sizes& sizes, double share);

/// Of a grain [m3].
double mean_volume(const Sizes& sizes);

/// The standard deviation of ln d, and its mean, where d has this mean and standard deviation.
struct LogNormal {
    double mean, sd;
};
LogNormal log_normal(double mean, double sd);

/// The column diameter_m of a CSV, sorted. Throws InputError.
std::vector<double> read_diameters(const std::string& file);

/// Grains of each of `shares` that add up to `count`: rounded down, the rest to the largest remainders.
std::vector<int> apportion(int count, const std::vector<double>& shares);

/// Grains of each species among `count`, from their fractions.
std::vector<int> species_counts(int count, const std::vector<Species>& species, FractionsBy by);

}  // namespace mcdem::scene
