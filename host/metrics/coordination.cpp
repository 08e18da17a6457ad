#include "metrics/coordination.h"

#include <Eigen/Core>
#include <algorithm>

#include "core/least_squares.h"
#include "metrics/top_force.h"

namespace mcdem::inline metrics {
namespace {

/// Number of forces in a sorted list that are at least tau.
double count_from(const std::vector<double>& forces, double tau) {
    return static_cast<double>(forces.end() - std::lower_bound(forces.begin(), forces.end(), tau));
}

void add_quantiles(const std::vector<double>& forces, std::vector<double>& into) {
    const std::size_t step = std::max<std::size_t>(1, forces.size() / 64);
    for (std::size_t i = 0; i < forces.size(); i += step) into.push_back(forces[i]);
}

double recorded_coordination(const Scan& scan) { return scan.coordination_number; }

}  // namespace

Coordination::Coordination(const Levels& levels, const Replicas& replicas)
    : replicas_(replicas.size()), levels_(levels.size()) {
    for (std::size_t r = 0; r < replicas.size(); ++r)
        for (const auto& level : levels) {
            Cell cell{contact_forces(level.scans[r])};
            cell.grain_scans = static_cast<double>(replicas[r]->diameter.size()) * cell.forces.scans;
            std::sort(cell.forces.grain_grain.begin(), cell.forces.grain_grain.end());
            std::sort(cell.forces.grain_wall.begin(), cell.forces.grain_wall.end());
            cells_.push_back(std::move(cell));
        }
}

Eigen::ArrayXXd Coordination::at_threshold(double tau) const {
    Eigen::ArrayXXd z(replicas_, levels_);
    for (Eigen::Index r = 0; r < replicas_; ++r)
        for (Eigen::Index l = 0; l < levels_; ++l) {
            const auto& [forces, grain_scans] = cell(r, l);
            const double contacts =
                2 * count_from(forces.grain_grain, tau) + count_from(forces.grain_wall, tau);
            z(r, l) = grain_scans > 0 ? contacts / grain_scans : not_available;
        }
    return z;
}

std::vector<double> Coordination::candidate_thresholds(int count) const {
    std::vector<double> all;
    for (const auto& cell : cells_) {
        add_quantiles(cell.forces.grain_grain, all);
        add_quantiles(cell.forces.grain_wall, all);
    }
    std::sort(all.begin(), all.end());
    std::vector<double> chosen{0};
    const std::size_t step = std::max<std::size_t>(1, all.size() / count);
    for (std::size_t i = 0; i < all.size(); i += step)
        if (all[i] > chosen.back()) chosen.push_back(all[i]);
    return chosen;
}

bool Coordination::known() const {
    return std::any_of(cells_.begin(), cells_.end(), [](const Cell& cell) { return cell.grain_scans > 0; });
}

Eigen::ArrayXXd reference_coordination(const Levels& levels, const Replicas& replicas) {
    const Coordination counted(levels, replicas);
    const auto from_contacts = counted.at_threshold(0);
    return from_contacts.isFinite().select(from_contacts, by_replica(levels, recorded_coordination));
}

namespace {

/// The RMS error as a function of tau.
class Objective {
public:
    Objective(const Coordination& simulated, const Eigen::ArrayXXd& reference,
              const std::vector<LevelMatch>& matches)
        : simulated_(simulated), reference_(reference), matches_(matches) {}
    LevelError operator()(double tau, const std::vector<Omission>& omissions) const {
        return rms_over_levels(at_reference(simulated_.at_threshold(tau), matches_), reference_, omissions);
    }
    double operator()(double tau) const { return (*this)(tau, {Omission{}}).by_omission[0]; }

private:
    const Coordination& simulated_;
    const Eigen::ArrayXXd& reference_;
    const std::vector<LevelMatch>& matches_;
};

std::vector<double> evenly(double from, double to, int count) {
    std::vector<double> points;
    for (int i = 0; i < count; ++i) points.push_back(from + (to - from) * i / (count - 1));
    return points;
}

/// The best candidate (first and last one of equally good neighbours), and its neighbours.
struct Best {
    double first, last;    ///< [N]
    double before, after;  ///< [N]
};
Best best_of(const Objective& objective, const std::vector<double>& candidates) {
    std::vector<double> values;
    for (double tau : candidates) values.push_back(objective(tau));
    const auto first = std::min_element(values.begin(), values.end()) - values.begin();
    auto last = first;
    const auto end = static_cast<std::ptrdiff_t>(values.size()) - 1;
    while (last < end && values[last + 1] == values[first]) ++last;
    return {candidates[first], candidates[last], candidates[std::max<std::ptrdiff_t>(first - 1, 0)],
            candidates[std::min(last + 1, end)]};
}

double minimising_tau(const Objective& objective, std::vector<double> candidates) {
    Best best = best_of(objective, candidates);
    for (int round = 0; round < 3 && best.before < best.after; ++round)
        best = best_of(objective, evenly(best.before, best.after, 101));
    if (best.first == 0) return 0;  // no threshold is as good as any other
    return (best.first + best.last) / 2;
}

/// Vertex of the least-squares parabola through squared errors; it is smooth while the objective has steps.
double vertex(const std::vector<double>& tau, const Eigen::ArrayXd& squared_error) {
    const auto n = static_cast<Eigen::Index>(tau.size());
    Eigen::MatrixXd powers(n, 3);
    const double middle = (tau.front() + tau.back()) / 2, half_width = (tau.back() - tau.front()) / 2;
    for (Eigen::Index i = 0; i < n; ++i) {
        const double x = (tau[i] - middle) / half_width;
        powers.row(i) << 1, x, x * x;
    }
    const Eigen::Vector3d c = least_squares(powers, squared_error.matrix());
    return c[2] > 0 ? middle - half_width * c[1] / (2 * c[2]) : not_available;
}

double error_of_tau(const Objective& objective, double tau, const Jackknife& jackknife) {
    if (!(tau > 0) || jackknife.omissions().size() < 2) return not_available;
    const auto window = evenly(0.7 * tau, 1.3 * tau, 41);
    Eigen::ArrayXXd squared(window.size(), jackknife.omissions().size());
    for (std::size_t i = 0; i < window.size(); ++i) {
        const auto errors = objective(window[i], jackknife.omissions()).by_omission;
        squared.row(i) = Eigen::Map<const Eigen::ArrayXd>(errors.data(), errors.size()).square();
    }
    std::vector<double> taus;
    for (Eigen::Index o = 0; o < squared.cols(); ++o) taus.push_back(vertex(window, squared.col(o)));
    return jackknife.estimate(taus).standard_error;
}

}  // namespace

CoordinationError coordination_error(const Levels& simulated, const Replicas& simulated_replicas,
                                     const Eigen::ArrayXXd& reference, const std::vector<LevelMatch>& matches,
                                     const Jackknife& jackknife) {
    const Coordination coordination(simulated, simulated_replicas);
    CoordinationError error;
    const auto finish = [&](const LevelError& levels) {
        error.errZ = jackknife.estimate(levels.by_omission);
        error.levels_used = levels.levels_used;
        return error;
    };
    if (!coordination.known())
        return finish(rms_over_levels(at_reference(by_replica(simulated, recorded_coordination), matches),
                                      reference, jackknife.omissions()));
    const Objective objective(coordination, reference, matches);
    const double tau = minimising_tau(objective, coordination.candidate_thresholds(2000));
    const auto levels = objective(tau, jackknife.omissions());
    finish(levels);
    if (levels.levels_used > 0) error.tau = {tau, error_of_tau(objective, tau, jackknife), error.errZ.count};
    return error;
}

}  // namespace mcdem::metrics
