// Finds gamma, or what else scales a top force, with Rtop = 1: the root of a noisy, rising function that may
// run away.
//
// The top force grows with gamma; every evaluation is a mean over replicas and scatters; above some gamma
// no static solution exists. Simulations are run in batches, so each round asks for several gammas at
// once: first spread over the bracket, then ever closer about the root, which a parabola (or a line, as
// long as points are few) fitted to all points of the neighbourhood gives, with its standard error from
// the scatter about the fit.
#pragma once
#include <functional>
#include <string>
#include <vector>

namespace mcdem::inline calibrate {

struct Bracket {
    double low = 0;
    double high = 0;
};

struct CalibrationOptions {
    double tolerance = 0.005;    ///< standard error of gamma at which to stop
    int batch = 6;               ///< gammas asked for in one round
    int rounds = 8;              ///< at most
    std::string what = "gamma";  ///< what is searched for, in messages
};

/// One round: what was asked, and what came back.
struct CalibrationRound {
    std::vector<double> gamma;
    std::vector<double> top_force;  ///< [N]; not-a-number where the simulation ran away
    double root = 0;  ///< estimate of gamma after this round; not-a-number as long as there is none
    double standard_error = 0;
};

struct Calibration {
    double gamma = 0;
    double standard_error = 0;
    bool converged = false;   ///< the tolerance was met within the rounds allowed
    double runs_away_at = 0;  ///< lowest gamma that ran away; not-a-number where none did
    std::vector<CalibrationRound> rounds;
};

/// Top force [N] at full stroke for each gamma, averaged over replicas; not-a-number where it ran away.
using TopForces = std::function<std::vector<double>(const std::vector<double>& gammas)>;

/// The gamma at which the top force is `target` [N]. Throws InputError for an impossible bracket, target
/// or option, RunError where the target is not reached within the bracket.
Calibration calibrate_gamma(const TopForces& top_forces, double target, const Bracket& bracket,
                            const CalibrationOptions& options = {});

}  // namespace mcdem::calibrate
