// Finds gamma, or another parameter that scales the top force, such that Rtop = 1: the root of a noisy,
// increasing function that may diverge.
//
// The top force increases with gamma. Every evaluation is a mean over replicas and has noise; above some
// gamma no static solution exists. Simulations run in batches, so each round evaluates several gammas at
// once: first spread over the bracket, then increasingly close to the root. The root comes from a parabola
// (or a line, while there are few points) fitted to all nearby points, its standard error from the scatter
// about the fit.
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
    double tolerance = 0.005;    ///< standard error of gamma at which the search stops
    int batch = 6;               ///< number of gammas per round
    int rounds = 8;              ///< maximum
    std::string what = "gamma";  ///< name of the parameter in messages
};

/// One round: the evaluated gammas and their top forces.
struct CalibrationRound {
    std::vector<double> gamma;
    std::vector<double> top_force;  ///< [N]; NaN if the simulation ran away
    double root = 0;                ///< estimate of gamma after this round; NaN while there is none
    double standard_error = 0;
};

struct Calibration {
    double gamma = 0;
    double standard_error = 0;  ///< from the scatter about the fit
    double slope = 0;         ///< increase of the top force with gamma, at gamma [N]; NaN if it is not known
    bool converged = false;   ///< the tolerance was reached within the allowed rounds
    double runs_away_at = 0;  ///< lowest gamma that ran away; NaN if none did
    std::vector<CalibrationRound> rounds;
};

/// Top force [N] at full stroke for each gamma, averaged over replicas; NaN if it ran away.
using TopForces = std::function<std::vector<double>(const std::vector<double>& gammas)>;

/// The gamma at which the top force is `target` [N]. Throws InputError for an invalid bracket, target or
/// option, RunError if the target is not reached within the bracket.
Calibration calibrate_gamma(const TopForces& top_forces, double target, const Bracket& bracket,
                            const CalibrationOptions& options = {});

}  // namespace mcdem::calibrate
