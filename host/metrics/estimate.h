// A number with its standard error, and the two ways of getting one from replicas: the spread of a
// mean, and leaving one replica out at a time (jackknife) for metrics that are no plain mean.
#pragma once
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace mcdem::inline metrics {

inline constexpr double not_available = std::numeric_limits<double>::quiet_NaN();

/// `standard_error` is over replicas; not-a-number where fewer than two tell it.
struct Estimate {
    double value = not_available;
    double standard_error = not_available;
    int count = 0;  ///< replicas it rests on
    bool available() const { return std::isfinite(value); }
};

/// Mean of what is finite, with its standard error.
Estimate mean_over_replicas(std::span<const double> values);

/// One number a replica, with the packing seed it comes from (empty where there is none).
struct Sample {
    std::vector<std::string> seed;
    std::vector<double> value;  ///< not-a-number where the replica does not have it
};

/// Positions (in a, in b) of the replicas that share a seed. None where the two sets of seeds differ,
/// a seed is missing or comes twice: then the two samples are independent.
using Pairs = std::vector<std::pair<int, int>>;
std::optional<Pairs> pair_by_seed(const std::vector<std::string>& a, const std::vector<std::string>& b);

/// mean(above) / mean(below). Where seeds pair up, over the pairs both of which have a value, and the
/// error takes in that they are correlated; else errors add in quadrature (one replica has none).
Estimate ratio_of_means(const Sample& above, const Sample& below);

/// One way to leave replicas out: the index of the one left out, or -1.
struct Omission {
    int simulated = -1;
    int reference = -1;
};

/// Leaves out one replica at a time on either side; pairs of one seed go together.
class Jackknife {
public:
    Jackknife(const std::vector<std::string>& simulated_seeds,
              const std::vector<std::string>& reference_seeds);
    /// The first leaves nothing out.
    const std::vector<Omission>& omissions() const { return omissions_; }
    /// From the metric's value under each omission.
    Estimate estimate(std::span<const double> value_by_omission) const;

private:
    std::vector<Omission> omissions_{Omission{}};
    std::vector<std::size_t> group_sizes_;  ///< omissions that belong together, after the first
};

}  // namespace mcdem::metrics
