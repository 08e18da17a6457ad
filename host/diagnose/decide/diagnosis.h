// What a diagnosis says: the content of diagnosis.json and of the page (README.md beside this file).
#pragma once
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace mcdem::inline diagnose {

enum class Verdict {
    no_gap,               ///< nothing detectable
    effect,               ///< one effect explains it
    group,                ///< one of several that these data cannot tell apart
    unknown_effect,       ///< a gap of which no effect of the library takes away enough
    not_converged,        ///< the simulation's own numerics explain it: a setting is to be refined
    calibration_suspect,  ///< a stated parameter lies far outside its uncertainty
};

/// Part of the data whose gap stands out of the noise.
struct WhereEntry {
    std::string observable;
    std::string phase;                         ///< load, unload, or empty: both
    std::array<double, 2> displacement{0, 0};  ///< of the plate, from and to [m]
    std::optional<std::string> region;
    std::optional<std::string> force_class;
    double z_score = 0;           ///< of the gap, over its noise
    double z_score_refitted = 0;  ///< .. after the nuisances were refitted
    double difference = 0;        ///< measured less simulated where it stands out most, in its own unit
};

/// One cell of the picture "where": every observable, significant or not.
struct WhereCell {
    std::string observable;
    std::string phase;
    double displacement = 0;  ///< [m]
    double z_score = 0, z_score_refitted = 0;
    double difference = 0;  ///< measured less simulated, in the observable's unit
};

struct Cause {
    std::string effect;
    double amplitude = 0;
    double amplitude_error = 0;  ///< one sigma
    std::string unit;
    double confidence = 0;           ///< probability among the library's effects
    double explained = 0;            ///< part of the chi-square of all differences, noise included
    std::vector<std::string> group;  ///< effects that these data cannot tell from it, itself included
    double score = 0;                ///< gain in log likelihood over no effect, nuisances refitted in both
    std::optional<double> confirmed_score;  ///< .. from real runs at the fitted amplitude
};

struct NuisanceFit {
    std::string name;
    double value = 0, error = 0;  ///< shift from the scene's value; one sigma after the fit
    double prior = 0;             ///< one sigma before
    std::string unit;
    bool at_bound = false;  ///< pulled further than its prior allows: a symptom
};

struct GapReduction {
    std::string held_out;          ///< which part of the data
    double before = 0, after = 0;  ///< gap without noise: sum over cells of squared differences in sigmas
    double fraction = 0;           ///< 1 - after/before
    std::array<double, 2> interval{0, 0};  ///< 90 %
    double placebo = 0;
    std::optional<double> confirmed;                       ///< fraction from real runs
    std::map<std::string, std::array<double, 2>> metrics;  ///< Rtop, errf [N], errZ, bhat: before and after
    std::vector<std::array<double, 4>>
        top_force;  ///< displacement [m], experiment, before, after [N], loading
    /// Stretch of the plate's displacement that the effect was fitted on [m]; equal ends: not one stretch.
    std::array<double, 2> fitted_displacement{0, 0};
};

/// How much of the gap the named explanation takes away, else the best one that there is: what the verdict
/// hangs on.
struct Explanation {
    double reduction = 0;    ///< part of the gap that it takes away
    bool simulated = false;  ///< by real runs, else by signatures
    bool held_out = true;    ///< of the gap on data held out; false: those show none, of the whole gap
    double placebo = 0;      ///< what the best of random signatures takes away
    double needed = 0;       ///< what it must take away to be named
    double remainder_p = 1;  ///< of what it leaves being noise
    bool leaves_more_than_noise = false;
    double remainder() const { return 1 - reduction; }
};

/// A setting of the simulation's numerics that the gap is consistent with.
struct Refinement {
    std::string effect, key, unit;
    double from = 0, to = 0;
    bool done = false;  ///< the diagnosis refined the scene itself and went on; else it is to be set
};

/// What to do next, in the user's terms.
struct NextStep {
    std::string what;
    std::optional<double> power;  ///< probability that it decides, predicted from the signatures
};

/// One of several packings that were diagnosed together.
struct PackingAgreement {
    std::string experiment;
    double gap_p = 1;                           ///< of its gap alone being noise
    double amplitude = 0, amplitude_error = 0;  ///< of the leading cause, by this packing alone
    double agreement_p = 1;                     ///< of what sets it apart from the others being noise
    bool differs = false;                       ///< it does so by more than noise, for one of so many
};

struct DetectionLimit {
    std::string effect, unit;
    double minimum_amplitude =
        std::numeric_limits<double>::infinity();  ///< infinite: these data never show it
    double absorbed_by_calibration = 0;           ///< part of its signature that nuisances take away
    std::vector<std::string> group;               ///< not to be told apart from it at twice that amplitude
};

struct Diagnosis {
    Verdict verdict = Verdict::no_gap;
    bool detected = false;
    double p_value = 1;  ///< the smaller of the two tests, corrected for there being two
    double p_omnibus = 1, p_directed = 1;
    std::vector<WhereEntry> where;
    std::vector<WhereCell> cells;
    std::vector<Cause> causes;   ///< best first; empty where there is no gap
    std::vector<Cause> ranking;  ///< all candidates by score, for the picture
    std::vector<NuisanceFit> nuisances;
    std::optional<Explanation> explanation;  ///< nothing where there is no gap
    std::optional<GapReduction> gap_reduction;
    std::vector<DetectionLimit> detection_limits;
    std::vector<PackingAgreement> packings;  ///< empty: only one
    std::vector<Refinement> refinements;
    std::vector<NextStep> next;             ///< the most useful first
    std::vector<std::string> not_measured;  ///< what is missing and what could have been told with it
    std::vector<std::string>
        not_testable;  ///< candidates that this scene or these data cannot show, with why
    double seconds = 0;
    std::map<std::string, std::string> provenance;  ///< scene, experiment, versions, device, seed, hashes
    double where_threshold = 0;  ///< |z| from which a cell stands out of all cells together; 0: not known
};

}  // namespace mcdem::diagnose
