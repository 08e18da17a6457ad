// Similarity of two distributions of the contact forces between grains (the paper: "interparticle"):
// Bhattacharyya's B = integral sqrt(p q) df at each level, and bhat = -log of the mean of B over levels.
//
// B is invariant under transformations of f, so bins need not have the same width. Their edges are quantiles
// of the two samples together, and every bin is well filled. Few bins blur the difference between p and q;
// many bins mistake noise for difference: with n and m contacts and K bins the plain sum of sqrt(p_i q_i) is
// too small by about (K - 1)/8 (1/n + 1/m). Therefore K grows as 2 min(n, m)^(2/5), and the bias, known for
// each bin from the counts, is added back. This assumes independent contacts.
#pragma once
#include "metrics/contact_forces.h"
#include "metrics/levels.h"

namespace mcdem::inline metrics {

/// Number of bins for samples of n and m contacts.
int bin_count(double n, double m);

/// Inner edges of `bins` bins with equal parts of the two samples together, with equal weight of both
/// samples. Coinciding edges (many equal forces) are merged.
std::vector<double> common_edges(const std::vector<double>& p, const std::vector<double>& q, int bins);

/// A histogram as probabilities, with the equivalent number of independent contacts.
struct Histogram {
    Eigen::ArrayXd probability;
    double contacts = 0;
};
Histogram histogram(const std::vector<double>& forces, const std::vector<double>& edges);

/// (1 - weight) a + weight b.
Histogram mixture(const Histogram& a, const Histogram& b, double weight);

/// Pools samples, except number `left_out`.
Histogram pool(const std::vector<Histogram>& parts, int left_out);

/// B, corrected for finite counts. NaN if either is empty.
double bhattacharyya(const Histogram& p, const Histogram& q);

struct DistributionDistance {
    Estimate bhat;
    int levels_used = 0;
};
/// Ignores levels at which either side has no recorded contacts. Between two simulated levels the
/// distribution is interpolated like any other quantity.
DistributionDistance distribution_distance(const Levels& simulated, const Levels& reference,
                                           const std::vector<LevelMatch>& matches,
                                           const Jackknife& jackknife);

/// Density p(f) at one level in equal bins from 0 to `largest` [N], for figures.
struct ForceDensity {
    std::vector<double> force;      ///< centre of each bin [N]
    std::vector<Estimate> density;  ///< [1/N]; error over replicas
};
ForceDensity force_density(const Level& level, int bins, double largest);

}  // namespace mcdem::metrics
