#include "scene/packing/sizes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/input_file.h"
#include "core/random.h"
#include "scene/packing/table.h"

namespace mcdem::inline scene {

LogNormal log_normal(double mean, double sd) {
    const double variance = std::log1p(sd * sd / (mean * mean));
    return {std::log(mean) - variance / 2, std::sqrt(variance)};
}

double quantile(const Sizes& sizes, double share) {
    switch (sizes.law) {
        case SizeLaw::single:
            return sizes.mean;
        case SizeLaw::table: {
            const auto place = static_cast<std::size_t>(share * static_cast<double>(sizes.table->size()));
            return (*sizes.table)[std::min(place, sizes.table->size() - 1)];
        }
        case SizeLaw::lognormal: {
            if (sizes.sd == 0) return sizes.mean;
            const auto [mean, sd] = log_normal(sizes.mean, sizes.sd);
            return std::exp(
                TruncatedNormal{mean, sd, std::log(sizes.min), std::log(sizes.max)}.quantile(share));
        }
        case SizeLaw::normal:
            break;
    }
    return TruncatedNormal{sizes.mean, sizes.sd, sizes.min, sizes.max}.quantile(share);
}

double mean_volume(const Sizes& sizes) {
    constexpr int samples = 200;
    double sum = 0;
    for (int i = 0; i < samples; ++i) sum += std::pow(quantile(sizes, (i + 0.5) / samples), 3);
    return std::numbers::pi / 6 * sum / samples;
}

std::vector<double> read_diameters(const std::string& file) {
    FileProblems problems;
    std::vector<double> diameters;
    const std::string text =
        read_file(file, file + ": must be a CSV with a column diameter_m, got no file that can be read");
    Table table(file, text, {"diameter_m"}, problems);
    while (!problems.full() && table.next()) {
        const auto diameter = table.number(0);
        if (diameter && !(*diameter >= 1e-7 && *diameter <= 10))
            table.problem(fmt::format("diameter_m must be between 1e-07 and 10 [m], got {}", *diameter));
        diameters.push_back(diameter.value_or(0));
    }
    problems.report();
    std::ranges::sort(diameters);
    return diameters;
}

std::vector<int> apportion(int count, const std::vector<double>& shares) {
    const double all = std::accumulate(shares.begin(), shares.end(), 0.0);
    std::vector<int> counts;
    std::vector<std::size_t> order(shares.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto exact = [&](std::size_t s) { return count * (shares[s] / all); };
    int left = count;
    for (std::size_t s = 0; s < shares.size(); ++s) {
        counts.push_back(static_cast<int>(exact(s)));
        left -= counts[s];
    }
    std::ranges::stable_sort(order, std::greater{}, [&](std::size_t s) { return exact(s) - counts[s]; });
    for (std::size_t k = 0; left > 0; k = (k + 1) % order.size(), --left) ++counts[order[k]];
    return counts;
}

std::vector<int> species_counts(int count, const std::vector<Species>& species, FractionsBy by) {
    std::vector<double> shares;
    for (const Species& one : species)
        shares.push_back(by == FractionsBy::volume ? one.fraction / mean_volume(one.sizes) : one.fraction);
    return apportion(count, shares);
}

}  // namespace mcdem::scene
