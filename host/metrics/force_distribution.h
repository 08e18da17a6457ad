// How alike two distributions of contact forces are: Bhattacharyya's B = integral sqrt(p q) df at each
// level, and bhat = -log of the mean of B over levels.
//
// B does not change when f is stretched, so bins need not be equally wide: their edges are quantiles of
// the two samples taken together, and every bin is well filled. Few bins blur the difference of p and q,
// many bins take noise for difference: with n and m contacts and K bins the plain sum of sqrt(p_i q_i)
// falls short by about (K - 1)/8 (1/n + 1/m). So K grows as 2 min(n, m)^(2/5), and that shortfall, known
// bin by bin from the counts, is added back. Contacts are taken as independent for that.
#pragma once
#include "metrics/contact_forces.h"
#include "metrics/levels.h"

namespace mcdem::inline metrics {

/// Number of bins for samples of n and m contacts.
int bin_count(double n, double m);

/// Inner edges of `bins` bins that hold equal parts of the two samples together, each sample weighing the
/// same. Edges that coincide (many equal forces) come once.
std::vector<double> common_edges(const std::vector<double>& p, const std::vector<double>& q, int bins);

/// A histogram as probabilities, with the number of independent contacts that it is worth.
struct Histogram {
    Eigen::ArrayXd probability;
    double contacts = 0;
};
Histogram histogram(const std::vector<double>& forces, const std::vector<double>& edges);

/// (1 - weight) a + weight b.
Histogram mixture(const Histogram& a, const Histogram& b, double weight);

/// Pools samples.
Histogram pool(const std::vector<Histogram>& parts, int left_out);

/// B, corrected for finite counts. Not-a-number where either is empty.
double bhattacharyya(const Histogram& p, const Histogram& q);

struct DistributionDistance {
    Estimate bhat;
    int levels_used = 0;
};
/// Levels where either side has no contacts recorded are left out. Between two simulated levels the
/// distribution is interpolated like any other quantity.
DistributionDistance distribution_distance(const Levels& simulated, const Levels& reference,
                                           const std::vector<LevelMatch>& matches, const Jackknife& jackknife,
                                           WallContacts walls);

/// Density p(f) at one level on equal bins from 0 to `largest` [N], for pictures.
struct ForceDensity {
    std::vector<double> force;      ///< middle of each bin [N]
    std::vector<Estimate> density;  ///< [1/N]; error over replicas
};
ForceDensity force_density(const Level& level, int bins, double largest, WallContacts walls);

}  // namespace mcdem::metrics
