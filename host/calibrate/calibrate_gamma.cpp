#include "calibrate/calibrate_gamma.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibrate/local_fit.h"
#include "core/errors.h"

namespace mcdem::inline calibrate {
namespace {

constexpr std::size_t points_for_an_error =
    6;  ///< with fewer, the scatter about the fit is too uncertain to stop

void check(double target, const Bracket& bracket, const CalibrationOptions& options) {
    std::vector<std::string> problems;
    const auto demand = [&](bool good, const char* what, double got) {
        if (!good) problems.push_back(fmt::format("calibration: {}, got {}", what, got));
    };
    demand(std::isfinite(target) && target > 0, "target top force must be > 0 [N]", target);
    demand(std::isfinite(bracket.low) && bracket.low >= 0, "low end of the bracket must be >= 0",
           bracket.low);
    demand(std::isfinite(bracket.high) && bracket.high > bracket.low,
           "high end of the bracket must be above its low end", bracket.high);
    demand(options.tolerance > 0, "tolerance must be > 0", options.tolerance);
    demand(options.batch >= 3, "batch must be at least 3 values per round", options.batch);
    demand(options.rounds >= 1, "rounds must be at least 1", options.rounds);
    if (!problems.empty()) throw InputError(problems);
}

std::vector<double> evenly(double low, double high, int count) {
    std::vector<double> values;
    for (int i = 0; i < count; ++i) values.push_back(low + (high - low) * i / (count - 1));
    return values;
}

/// All results so far.
class Evidence {
public:
    void add(const CalibrationRound& round) {
        for (std::size_t i = 0; i < round.gamma.size(); ++i) {
            if (std::isfinite(round.top_force[i]))
                finite_.push_back({round.gamma[i], round.top_force[i]});
            else
                runs_away_at_ = std::fmin(runs_away_at_, round.gamma[i]);
        }
        // Results above the lowest gamma that ran away are not reliable.
        std::erase_if(finite_, [&](const Point& p) { return p.x > runs_away_at_; });
        std::sort(finite_.begin(), finite_.end(), [](const Point& a, const Point& b) { return a.x < b.x; });
    }
    const std::vector<Point>& finite() const { return finite_; }
    double runs_away_at() const { return runs_away_at_; }
    /// End of the interval below the lowest runaway, at some distance from it.
    double highest_safe(double high) const {
        if (std::isnan(runs_away_at_) || finite_.empty()) return high;
        return std::min(high, (finite_.back().x + runs_away_at_) / 2);
    }
    std::size_t count(double low, double high) const {
        return std::count_if(finite_.begin(), finite_.end(),
                             [&](const Point& p) { return p.x >= low && p.x <= high; });
    }

private:
    std::vector<Point> finite_;
    double runs_away_at_ = none;
};

/// Neighbours between which the increasing fit crosses the target; `below` or `above` is NaN if all points
/// are on the other side.
struct Neighbours {
    double below = none, above = none;
};
Neighbours neighbours(const std::vector<Point>& points, double target) {
    const auto rising = rising_fit(points);
    Neighbours found;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (rising[i] < target)
            found.below = points[i].x;
        else if (std::isnan(found.above))
            found.above = points[i].x;
    }
    return found;
}

/// Next interval of the search: `centre` plus and minus `half_width`.
struct Window {
    double centre = none, half_width = none;
    double low() const { return centre - half_width; }
    double high() const { return centre + half_width; }
};

[[noreturn]] void fail_out_of_reach(const Evidence& evidence, double target, const Bracket& bracket,
                                    const std::string& what) {
    const auto& points = evidence.finite();
    if (points.empty())
        throw RunError(
            fmt::format("calibration: the packing runs away already at {} = {:.4g}; give a bracket "
                        "that starts lower",
                        what, evidence.runs_away_at()));
    if (std::isnan(neighbours(points, target).below))
        throw RunError(
            fmt::format("calibration: the top force is {:.4g} N already at {} = {:.4g}, above the "
                        "target of {:.4g} N; give a bracket that starts lower, or check the modulus",
                        points.front().y, what, points.front().x, target));
    if (std::isnan(evidence.runs_away_at()))
        throw RunError(
            fmt::format("calibration: the top force comes only to {:.4g} N at {} = {:.4g}, the target "
                        "is {:.4g} N; give a bracket that ends higher than {:.4g}",
                        points.back().y, what, points.back().x, target, bracket.high));
    throw RunError(
        fmt::format("calibration: the packing runs away at {} = {:.4g} before it comes to the target "
                    "of {:.4g} N ({:.4g} N at {} = {:.4g}); no {} gives Rtop = 1 here",
                    what, evidence.runs_away_at(), target, points.back().y, what, points.back().x, what));
}

/// Points in the part of the bracket below the lowest runaway, while the target has not been crossed.
std::vector<double> explore(const Evidence& evidence, double target, const Bracket& bracket,
                            const CalibrationOptions& options) {
    const auto& points = evidence.finite();
    const double from = points.empty() ? bracket.low : points.back().x;
    const double to = evidence.runs_away_at();
    const bool open = points.empty() ? to > bracket.low : !std::isnan(neighbours(points, target).below);
    if (!open || !(to - from > options.tolerance)) fail_out_of_reach(evidence, target, bracket, options.what);
    auto inner = evenly(from, to, options.batch + 2);  // both ends are known
    return {inner.begin() + 1, inner.end() - 1};
}

std::vector<double> ask(const TopForces& top_forces, const std::vector<double>& gammas) {
    auto forces = top_forces(gammas);
    if (forces.size() != gammas.size())
        throw RunError(
            fmt::format("calibration: asked for {} top forces, got {}", gammas.size(), forces.size()));
    return forces;
}

/// Window around the root after a round: first from the bracketing neighbours, then half as wide each time,
/// but wide enough that the slope is significant.
Window next_window(const Window& last, const Neighbours& around, const Crossing& root) {
    if (std::isnan(last.centre))
        return {(around.below + around.above) / 2, 1.5 * std::abs(around.above - around.below)};
    if (std::isnan(root.x)) return {(around.below + around.above) / 2, last.half_width};
    return {root.x, std::fmax(last.half_width / 2, std::fmin(5 * root.standard_error, last.half_width))};
}

}  // namespace

Calibration calibrate_gamma(const TopForces& top_forces, double target, const Bracket& bracket,
                            const CalibrationOptions& options) {
    check(target, bracket, options);
    Calibration result{none, none, none, false, none, {}};
    Evidence evidence;
    Window window;
    auto gammas = evenly(bracket.low, bracket.high, options.batch);
    while (static_cast<int>(result.rounds.size()) < options.rounds && !result.converged) {
        CalibrationRound round{gammas, ask(top_forces, gammas), none, none};
        evidence.add(round);
        result.runs_away_at = evidence.runs_away_at();
        const auto around = neighbours(evidence.finite(), target);
        if (std::isnan(around.below) || std::isnan(around.above)) {
            gammas = explore(evidence, target, bracket, options);
            result.rounds.push_back(round);
            continue;
        }
        const bool first = std::isnan(window.centre);
        if (first) window = next_window(window, around, {});
        const auto root = crossing_of_fit(evidence.finite(), window.low(), window.high(), target);
        round.root = result.gamma = std::isnan(root.x) ? (around.below + around.above) / 2 : root.x;
        round.standard_error = result.standard_error = root.standard_error;
        result.slope = root.slope;
        result.rounds.push_back(round);
        result.converged = root.standard_error <= options.tolerance &&
                           evidence.count(window.low(), window.high()) >= points_for_an_error;
        if (!first) window = next_window(window, around, root);
        gammas = evenly(std::max(window.low(), bracket.low),
                        evidence.highest_safe(std::min(window.high(), bracket.high)), options.batch);
    }
    if (std::isnan(result.gamma)) fail_out_of_reach(evidence, target, bracket, options.what);
    return result;
}

}  // namespace mcdem::calibrate
