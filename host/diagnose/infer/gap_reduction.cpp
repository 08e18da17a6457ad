#include "diagnose/infer/gap_reduction.h"

#include <algorithm>
#include <cmath>

#include "scene/random.h"

namespace mcdem::inline diagnose {
namespace {

constexpr int bootstrap_draws = 200;
constexpr int placebo_signatures = 20;

/// Both comparisons, sharing the whitening of the fitted cells.
class Arms {
public:
    Arms(const GapData& data, const Split& split, int mean_of)
        : data_(data),
          held_out_(split.held_out),
          mean_of_(mean_of),
          space_(data.noise, mean_of, split.fitted, data.free) {}

    /// Remainder after refitting the nuisances.
    Eigen::VectorXd refitted(Eigen::VectorXd gap) const {
        const Eigen::VectorXd shifts = space_.fit_nuisances(gap);
        for (Eigen::Index k = 0; k < shifts.size(); ++k) gap -= shifts[k] * data_.free[k].direction;
        return gap;
    }

    PartialFit fit(const Eigen::VectorXd& gap, const std::vector<Candidate>& candidates) const {
        const GapSpace& space = space_.lacking(lacking_cells(candidates));
        const std::vector<double> amplitudes = fit_effects(space, candidates, gap).amplitudes;
        Eigen::VectorXd left = gap;
        for (std::size_t k = 0; k < candidates.size(); ++k)
            left -= candidates[k].signature->at(amplitudes[k]);
        return {amplitudes, space.fit_nuisances(left)};
    }

    Eigen::VectorXd explained(const PartialFit& fit, const std::vector<Candidate>& candidates) const {
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(data_.mean.size());
        for (std::size_t k = 0; k < candidates.size(); ++k)
            sum += candidates[k].signature->at(fit.amplitudes[k]);
        for (Eigen::Index k = 0; k < fit.nuisances.size(); ++k)
            sum += fit.nuisances[k] * data_.free[k].direction;
        return sum;
    }

    /// Size of the gap on the held-out cells without and with the candidates.
    std::array<double, 2> sizes(const Eigen::VectorXd& gap, const std::vector<Candidate>& candidates,
                                int extra = 0) const {
        const Eigen::VectorXd before = refitted(gap);
        Eigen::VectorXd after = gap - explained(fit(gap, candidates), candidates);
        for (const auto cell : lacking_cells(candidates)) after[cell] = before[cell];
        return {gap_size(data_, held_out_, before, mean_of_, extra),
                gap_size(data_, held_out_, after, mean_of_, extra)};
    }

private:
    const GapData& data_;
    const CellChoice& held_out_;
    int mean_of_;
    GapSpace space_;
};

double part_gone(const std::array<double, 2>& sizes) {
    return sizes[0] > 0 ? std::clamp(1 - sizes[1] / sizes[0], -1.0, 1.0) : 0;
}

/// A random signature of typical size: a random mixture of the replicates' scatter.
Signature random_signature(const GapData& data, Random& random) {
    Signature s;
    s.reach = 1;
    s.linear = Eigen::VectorXd::Zero(data.mean.size());
    for (Eigen::Index r = 0; r < data.noise.rows(); ++r)
        s.linear += random.normal() * data.noise.row(r).transpose();
    s.curvature = Eigen::VectorXd::Zero(s.linear.size());
    return s;
}

/// The largest value of `part` for random signatures.
template <class Part>
double best_placebo(const GapData& data, std::uint64_t seed, Part part) {
    Random random(seed, Stream::placebo);
    double best = 0;
    for (int k = 0; k < placebo_signatures; ++k) {
        const Signature signature = random_signature(data, random);
        best = std::max(best, part(Candidate{&signature, -50, 50}));
    }
    return best;
}

std::vector<Candidate> chosen_candidates(const GapData& data, const std::vector<std::size_t>& chosen) {
    std::vector<Candidate> candidates;
    for (const auto c : chosen) candidates.push_back(data.candidates[c]);
    return candidates;
}

}  // namespace

Split split_cells(const CellChoice& cells, const Grid& grid) {
    const auto all = cells_of(grid);
    Split split;
    for (const auto cell : cells) {
        const Cell& c = all[cell];
        const bool fitted = c.phase == Phase::load && c.displacement < fitted_part * grid.stroke;
        (fitted ? split.fitted : split.held_out).push_back(cell);
    }
    return split;
}

double gap_size(const GapData& data, const CellChoice& cells, const Eigen::VectorXd& gap, int mean_of,
                int extra) {
    const double both = 1 + extra + (mean_of > 0 ? 1.0 / mean_of : 0);
    const Eigen::ArrayXd finest = resolutions(cells, gap.size()).square();
    double size = 0;
    for (std::size_t k = 0; k < cells.size(); ++k) {
        const double scatter =
            data.noise.col(cells[k]).squaredNorm() / static_cast<double>(data.noise.rows());
        const double variance = scatter + finest[k];
        size += (gap[cells[k]] * gap[cells[k]] - both * scatter) / variance;
    }
    return size;
}

PartialFit stepped(const GapData& data, const std::vector<std::size_t>& candidates, PartialFit fit,
                   const Eigen::VectorXd& step) {
    const Eigen::Index nuisances = fit.nuisances.size();
    fit.nuisances = data.in_range(fit.nuisances + step.head(nuisances));
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        const Candidate& candidate = data.candidates[candidates[k]];
        fit.amplitudes[k] =
            std::clamp(fit.amplitudes[k] + step[nuisances + k], candidate.low, candidate.high);
    }
    return fit;
}

PartialFit fit_part(const GapData& data, const CellChoice& cells, const Eigen::VectorXd& gap,
                    const std::vector<std::size_t>& chosen, int mean_of) {
    PartialFit fit = Arms(data, {cells, {}}, mean_of).fit(gap, chosen_candidates(data, chosen));
    fit.nuisances = data.in_range(fit.nuisances);
    return fit;
}

PartialFit refit_part(const GapData& data, const CellChoice& cells, const Eigen::VectorXd& left,
                      const std::vector<std::size_t>& candidates, const PartialFit& at, int mean_of) {
    std::vector<FreeParameter> free = data.free;
    Eigen::VectorXd without_nuisances = left;
    for (std::size_t k = 0; k < data.free.size(); ++k)
        without_nuisances += at.nuisances[k] * data.free[k].direction;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        const Candidate& candidate = data.candidates[candidates[k]];
        free.push_back({candidate.signature->slope(at.amplitudes[k]), candidate.high - candidate.low});
    }
    const GapSpace space(data.noise, mean_of, without(cells, data.lacking(candidates)), free);
    const Eigen::VectorXd step = space.fit_nuisances(without_nuisances);
    return stepped(data, candidates, {at.amplitudes, Eigen::VectorXd::Zero(at.nuisances.size())}, step);
}

HeldOutGap held_out_gap(const GapData& data, const Split& split, int mean_of) {
    if (split.fitted.empty() || split.held_out.empty()) return {};
    const Arms arms(data, split, mean_of);
    const double both = std::sqrt(1 + (mean_of > 0 ? 1.0 / mean_of : 0));
    const auto size = [&](const Eigen::VectorXd& gap) {
        return gap_size(data, split.held_out, arms.refitted(gap), mean_of);
    };
    double square = 0;
    for (const auto& row : data.noise.rowwise()) square += std::pow(size(both * row.transpose()), 2);
    return {size(data.gap), std::sqrt(square / static_cast<double>(data.noise.rows()))};
}

double held_out_reduction(const GapData& data, const Split& split, const std::vector<std::size_t>& candidates,
                          int mean_of) {
    if (split.fitted.empty() || split.held_out.empty()) return 0;
    return part_gone(Arms(data, split, mean_of).sizes(data.gap, chosen_candidates(data, candidates)));
}

std::optional<double> reduction_by_runs(const GapData& data, const Split& split,
                                        const Eigen::VectorXd& observed, const Eigen::MatrixXd& all_runs,
                                        int mean_of, const CellChoice& lacking) {
    const Eigen::MatrixXd runs = whole_runs(all_runs, without(split.held_out, lacking));
    const double before = held_out_gap(data, split, mean_of).size;
    if (runs.rows() == 0 || !(before > 0)) return std::nullopt;
    Eigen::VectorXd left = observed - runs.colwise().mean().transpose();
    const Eigen::VectorXd unexplained = Arms(data, split, mean_of).refitted(data.gap);
    for (const auto cell : lacking)
        if (!std::isfinite(left[cell])) left[cell] = unexplained[cell];
    const double after = gap_size(data, split.held_out, left, static_cast<int>(runs.rows()));
    return std::clamp(1 - after / before, -1.0, 1.0);
}

double held_out_placebo(const GapData& data, const Split& split, int mean_of, std::uint64_t seed) {
    if (split.fitted.empty() || split.held_out.empty()) return 0;
    const Arms arms(data, split, mean_of);
    return best_placebo(data, seed,
                        [&](const Candidate& random) { return part_gone(arms.sizes(data.gap, {random})); });
}

double whole_placebo(const GapSpace& space, const GapData& data, double excess, std::uint64_t seed) {
    return best_placebo(data, seed, [&](const Candidate& random) {
        return std::min(1.0, fit_effect(space, random, data.gap).score / excess);
    });
}

GapReduction measure_reduction(const GapData& data, const Split& split, const Proposal& proposal, int mean_of,
                               std::uint64_t seed) {
    GapReduction gap_reduction;
    gap_reduction.held_out = "unloading, and loading beyond 85 % of the stroke";
    if (split.fitted.empty() || split.held_out.empty()) return gap_reduction;
    const std::vector<Candidate> candidates = chosen_candidates(data, proposal.candidates);
    const Arms arms(data, split, mean_of);
    const auto sizes = arms.sizes(data.gap, candidates);
    gap_reduction.before = sizes[0];
    gap_reduction.after = sizes[1];
    gap_reduction.fraction = part_gone(sizes);
    Random random(seed, Stream::bootstrap);
    std::vector<double> drawn;
    for (int draw = 0; draw < bootstrap_draws; ++draw) {
        const auto row = static_cast<Eigen::Index>(random.uniform() * static_cast<double>(data.noise.rows()));
        const double sign = random.uniform() < 0.5 ? -1 : 1;
        drawn.push_back(
            part_gone(arms.sizes(data.gap + sign * data.noise.row(row).transpose(), candidates, 1)));
    }
    std::ranges::sort(drawn);
    gap_reduction.interval = {drawn[bootstrap_draws / 20], drawn[bootstrap_draws - 1 - bootstrap_draws / 20]};
    return gap_reduction;
}

}  // namespace mcdem::diagnose
