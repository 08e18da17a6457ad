// Size distributions of species.
#pragma once
#include <string>
#include <vector>

#include "scene/species.h"

namespace mcdem::inline scene {

/// Quantile: the diameter below which a fraction `share` in (0, 1) of the grains lies [m].
double quantile(const Sizes& sizes, double share);

/// Mean volume of a grain [m3].
double mean_volume(const Sizes& sizes);

/// Standard deviation and mean of ln d for a given mean and standard deviation of d.
struct LogNormal {
    double mean, sd;
};
LogNormal log_normal(double mean, double sd);

/// The column diameter_m of a CSV file, sorted. Throws InputError.
std::vector<double> read_diameters(const std::string& file);

/// Distributes `count` grains according to `shares` by the method of largest remainders.
std::vector<int> apportion(int count, const std::vector<double>& shares);

/// Number of grains of each species among `count`, from their fractions.
std::vector<int> species_counts(int count, const std::vector<Species>& species, FractionsBy by);

}  // namespace mcdem::scene
