#include "metrics/force_distribution.h"

#include <algorithm>

namespace mcdem::inline metrics {
namespace {

/// At most about `most` of the forces, at equal distances in the sorted list; sufficient to place edges.
std::vector<double> sorted_sketch(const std::vector<double>& forces, std::size_t most) {
    const std::size_t step = std::max<std::size_t>(1, forces.size() / most);
    std::vector<double> sketch;
    for (std::size_t i = 0; i < forces.size(); i += step) sketch.push_back(forces[i]);
    std::sort(sketch.begin(), sketch.end());
    return sketch;
}

std::vector<double> concatenate(const std::vector<std::vector<double>>& lists) {
    std::vector<double> all;
    for (const auto& list : lists) all.insert(all.end(), list.begin(), list.end());
    return all;
}

std::vector<std::vector<double>> forces_by_replica(const Level& level) {
    std::vector<std::vector<double>> lists;
    for (const auto& scans : level.scans) lists.push_back(contact_forces(scans).grain_grain);
    return lists;
}

std::vector<Histogram> histograms(const std::vector<std::vector<double>>& lists,
                                  const std::vector<double>& edges) {
    std::vector<Histogram> all;
    for (const auto& list : lists) all.push_back(histogram(list, edges));
    return all;
}

/// B at one level for each omission.
std::vector<double> overlaps(const Level& below, const Level& above, double weight, const Level& reference,
                             const std::vector<Omission>& omissions) {
    const auto p_below = forces_by_replica(below), q = forces_by_replica(reference);
    const auto p_above = &below == &above ? p_below : forces_by_replica(above);
    auto p_all = concatenate(p_below);
    if (&below != &above) {
        const auto more = concatenate(p_above);
        p_all.insert(p_all.end(), more.begin(), more.end());
    }
    const auto q_all = concatenate(q);
    const auto edges = common_edges(p_all, q_all, bin_count(p_all.size(), q_all.size()));
    const auto counts_below = histograms(p_below, edges), counts_above = histograms(p_above, edges);
    const auto counts_q = histograms(q, edges);
    std::vector<double> b;
    for (const auto& omission : omissions)
        b.push_back(bhattacharyya(
            mixture(pool(counts_below, omission.simulated), pool(counts_above, omission.simulated), weight),
            pool(counts_q, omission.reference)));
    return b;
}

}  // namespace

int bin_count(double n, double m) {
    return static_cast<int>(std::clamp(2 * std::pow(std::min(n, m), 0.4), 4.0, 100.0));
}

std::vector<double> common_edges(const std::vector<double>& p, const std::vector<double>& q, int bins) {
    const auto sketch_p = sorted_sketch(p, 20000), sketch_q = sorted_sketch(q, 20000);
    std::vector<std::pair<double, double>> weighted;  // force, weight
    for (double f : sketch_p) weighted.emplace_back(f, 0.5 / sketch_p.size());
    for (double f : sketch_q) weighted.emplace_back(f, 0.5 / sketch_q.size());
    std::sort(weighted.begin(), weighted.end());
    std::vector<double> edges;
    double share = 0;
    for (const auto& [force, weight] : weighted) {
        share += weight;
        if (share * bins < edges.size() + 1.0) continue;
        if (edges.empty() || force > edges.back()) edges.push_back(force);
    }
    if (!edges.empty()) edges.pop_back();  // the last one is the largest force
    return edges;
}

Histogram histogram(const std::vector<double>& forces, const std::vector<double>& edges) {
    Histogram result{Eigen::ArrayXd::Zero(edges.size() + 1), static_cast<double>(forces.size())};
    for (double f : forces)
        result.probability[std::upper_bound(edges.begin(), edges.end(), f) - edges.begin()] += 1;
    if (!forces.empty()) result.probability /= result.contacts;
    return result;
}

Histogram mixture(const Histogram& a, const Histogram& b, double weight) {
    if (weight == 0) return a;
    if (a.contacts == 0 || b.contacts == 0) return {a.probability, 0};
    const double variance = (1 - weight) * (1 - weight) / a.contacts + weight * weight / b.contacts;
    return {(1 - weight) * a.probability + weight * b.probability, 1 / variance};
}

Histogram pool(const std::vector<Histogram>& parts, int left_out) {
    Histogram all{Eigen::ArrayXd::Zero(parts.empty() ? 0 : parts[0].probability.size()), 0};
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (static_cast<int>(i) == left_out) continue;
        all.probability += parts[i].probability * parts[i].contacts;
        all.contacts += parts[i].contacts;
    }
    if (all.contacts > 0) all.probability /= all.contacts;
    return all;
}

double bhattacharyya(const Histogram& p, const Histogram& q) {
    if (p.contacts == 0 || q.contacts == 0) return not_available;
    double sum = 0;
    for (Eigen::Index i = 0; i < p.probability.size(); ++i) {
        const double a = p.probability[i], b = q.probability[i];
        if (a == 0 || b == 0) continue;
        // second-order bias of sqrt(a b) for binomial a and b
        sum += std::sqrt(a * b) * (1 + (1 - a) / (8 * p.contacts * a) + (1 - b) / (8 * q.contacts * b));
    }
    return sum;
}

DistributionDistance distribution_distance(const Levels& simulated, const Levels& reference,
                                           const std::vector<LevelMatch>& matches,
                                           const Jackknife& jackknife) {
    DistributionDistance distance;
    std::vector<double> sums(jackknife.omissions().size(), 0);
    for (std::size_t l = 0; l < matches.size(); ++l) {
        if (!matches[l].found()) continue;
        const auto b = overlaps(simulated[matches[l].below], simulated[matches[l].above], matches[l].weight,
                                reference[l], jackknife.omissions());
        if (!std::isfinite(b[0])) continue;
        ++distance.levels_used;
        for (std::size_t o = 0; o < b.size(); ++o) sums[o] += b[o];
    }
    if (distance.levels_used == 0) return distance;
    std::vector<double> bhat;
    for (double sum : sums) bhat.push_back(-std::log(sum / distance.levels_used));
    distance.bhat = jackknife.estimate(bhat);
    distance.bhat.value = std::max(0.0, distance.bhat.value);  // noise can increase the corrected B above 1
    return distance;
}

ForceDensity force_density(const Level& level, int bins, double largest) {
    ForceDensity result;
    const double width = largest / bins;
    std::vector<double> edges;
    for (int i = 1; i <= bins; ++i) edges.push_back(i * width);
    const auto replicas = histograms(forces_by_replica(level), edges);
    for (int i = 0; i < bins; ++i) {
        std::vector<double> densities;
        for (const auto& replica : replicas)
            densities.push_back(replica.contacts > 0 ? replica.probability[i] / width : not_available);
        result.force.push_back((i + 0.5) * width);
        result.density.push_back(mean_over_replicas(densities));
    }
    return result;
}

}  // namespace mcdem::metrics
