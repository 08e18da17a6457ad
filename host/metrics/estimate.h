// Estimates with standard errors over replicas, from the scatter of a mean, or by the jackknife (leaving one
// replica out at a time) for other metrics.
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

/// `standard_error` is over replicas; NaN if there are fewer than two.
struct Estimate {
    double value = not_available;
    double standard_error = not_available;
    int count = 0;  ///< number of replicas
    bool available() const { return std::isfinite(value); }
};

/// Mean of the finite values, with its standard error.
Estimate mean_over_replicas(std::span<const double> values);

/// One value per replica with its packing seed (empty if there is none).
struct Sample {
    std::vector<std::string> seed;
    std::vector<double> value;  ///< NaN if the replica has no value
};

/// Index pairs (in a, in b) of replicas with the same seed. Empty if the two sets of seeds differ, or a seed
/// is missing or repeated: then the two samples are independent.
using Pairs = std::vector<std::pair<int, int>>;
std::optional<Pairs> pair_by_seed(const std::vector<std::string>& a, const std::vector<std::string>& b);

/// mean(above) / mean(below). If seeds pair up, only pairs with both values are used and the error includes
/// their correlation; otherwise errors add in quadrature (a single replica has none).
Estimate ratio_of_means(const Sample& above, const Sample& below);

/// Index of the replica that is left out, or -1.
struct Omission {
    int simulated = -1;
    int reference = -1;
};

/// Leaves out one replica at a time on either side; pairs with the same seed are left out together.
class Jackknife {
public:
    Jackknife(const std::vector<std::string>& simulated_seeds,
              const std::vector<std::string>& reference_seeds);
    /// The first one leaves nothing out.
    const std::vector<Omission>& omissions() const { return omissions_; }
    /// Estimate from the metric's value under each omission.
    Estimate estimate(std::span<const double> value_by_omission) const;

private:
    std::vector<Omission> omissions_{Omission{}};
    std::vector<std::size_t> group_sizes_;  ///< numbers of omissions in each group, after the first omission
};

}  // namespace mcdem::metrics
