#include "metrics/estimate.h"

#include <map>

namespace mcdem::inline metrics {

Estimate mean_over_replicas(std::span<const double> values) {
    double sum = 0;
    int count = 0;
    for (double value : values)
        if (std::isfinite(value)) sum += value, ++count;
    if (count == 0) return {};
    const double mean = sum / count;
    if (count == 1) return {mean, not_available, 1};
    double squares = 0;
    for (double value : values)
        if (std::isfinite(value)) squares += (value - mean) * (value - mean);
    return {mean, std::sqrt(squares / (count - 1) / count), count};
}

std::optional<Pairs> pair_by_seed(const std::vector<std::string>& a, const std::vector<std::string>& b) {
    if (a.size() != b.size() || a.empty()) return std::nullopt;
    std::map<std::string, int> where_in_b;
    for (std::size_t i = 0; i < b.size(); ++i)
        if (b[i].empty() || !where_in_b.emplace(b[i], static_cast<int>(i)).second) return std::nullopt;
    Pairs pairs;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const auto found = where_in_b.find(a[i]);
        if (found == where_in_b.end()) return std::nullopt;
        pairs.emplace_back(static_cast<int>(i), found->second);
        where_in_b.erase(found);  // a seed that occurs twice in `a` is not found again
    }
    return pairs;
}

namespace {

Estimate ratio_of_pairs(const Sample& above, const Sample& below, const Pairs& pairs) {
    double sum_above = 0, sum_below = 0;
    int count = 0;
    const auto both = [&](const std::pair<int, int>& pair) {
        return std::isfinite(above.value[pair.first]) && std::isfinite(below.value[pair.second]);
    };
    for (const auto& pair : pairs)
        if (both(pair)) sum_above += above.value[pair.first], sum_below += below.value[pair.second], ++count;
    if (count == 0) return {};
    const double ratio = sum_above / sum_below;
    if (count == 1) return {ratio, not_available, 1};
    double squares = 0;
    for (const auto& pair : pairs)
        if (both(pair)) squares += std::pow(above.value[pair.first] - ratio * below.value[pair.second], 2);
    return {ratio, std::sqrt(squares / (count - 1) / count) / std::abs(sum_below / count), count};
}

}  // namespace

Estimate ratio_of_means(const Sample& above, const Sample& below) {
    if (const auto pairs = pair_by_seed(above.seed, below.seed); pairs && pairs->size() > 1)
        return ratio_of_pairs(above, below, *pairs);
    const Estimate a = mean_over_replicas(above.value), b = mean_over_replicas(below.value);
    if (!a.available() || !b.available()) return {};
    const double ratio = a.value / b.value;
    if (a.count < 2 && b.count < 2) return {ratio, not_available, a.count};
    const double error_a = a.count < 2 ? 0 : a.standard_error / b.value;
    const double error_b = b.count < 2 ? 0 : ratio * b.standard_error / b.value;
    return {ratio, std::hypot(error_a, error_b), a.count};
}

Jackknife::Jackknife(const std::vector<std::string>& simulated_seeds,
                     const std::vector<std::string>& reference_seeds) {
    if (const auto pairs = pair_by_seed(simulated_seeds, reference_seeds); pairs && pairs->size() > 1) {
        for (const auto& [simulated, reference] : *pairs) omissions_.push_back({simulated, reference});
        group_sizes_ = {pairs->size()};
        return;
    }
    if (simulated_seeds.size() > 1) {
        for (std::size_t i = 0; i < simulated_seeds.size(); ++i)
            omissions_.push_back({static_cast<int>(i), -1});
        group_sizes_.push_back(simulated_seeds.size());
    }
    if (reference_seeds.size() > 1) {
        for (std::size_t i = 0; i < reference_seeds.size(); ++i)
            omissions_.push_back({-1, static_cast<int>(i)});
        group_sizes_.push_back(reference_seeds.size());
    }
}

Estimate Jackknife::estimate(std::span<const double> value_by_omission) const {
    Estimate estimate{value_by_omission[0], not_available, 1};
    double variance = 0;
    std::size_t first = 1;
    for (std::size_t size : group_sizes_) {
        double mean = 0, squares = 0;
        for (std::size_t i = first; i < first + size; ++i) mean += value_by_omission[i] / size;
        for (std::size_t i = first; i < first + size; ++i)
            squares += std::pow(value_by_omission[i] - mean, 2);
        variance += squares * (size - 1.0) / size;
        estimate.count = std::max(estimate.count, static_cast<int>(size));
        first += size;
    }
    if (!group_sizes_.empty()) estimate.standard_error = std::sqrt(variance);
    return estimate;
}

}  // namespace mcdem::metrics
