// Results of a diagnosis: the content of diagnosis.json and of the page (host/diagnose/DIAGNOSIS_OUTPUT.md).
#pragma once
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace mcdem::inline diagnose {

enum class Verdict {
    no_gap,               ///< no detectable gap
    effect,               ///< one effect explains it
    group,                ///< one of several effects that these data cannot distinguish
    unknown_effect,       ///< a gap, but no effect of the library takes away enough of it
    not_converged,        ///< the simulation's own numerics explain it: a setting must be refined
    calibration_suspect,  ///< a stated parameter is far outside its uncertainty
};

/// Part of the data with a significant gap.
struct WhereEntry {
    std::string observable;
    std::string phase;                         ///< load, unload, or empty for both
    std::array<double, 2> displacement{0, 0};  ///< of the plate, from - to [m]
    std::optional<std::string> region;
    std::optional<std::string> force_class;
    double z_score = 0;           ///< gap over its noise
    double z_score_refitted = 0;  ///< the same after refitting the nuisances
    double difference =
        0;  ///< measured minus simulated at the most significant cell, in the observable's unit
};

/// One cell of the figure "where": every observable, significant or not.
struct WhereCell {
    std::string observable;
    std::string phase;
    double displacement = 0;  ///< [m]
    double z_score = 0, z_score_refitted = 0;
    double difference = 0;  ///< measured minus simulated, in the observable's unit
};

struct Cause {
    std::string effect;
    double amplitude = 0;
    double amplitude_error = 0;  ///< one sigma
    bool at_limit = false;       ///< within one sigma of the end of its range: it may also be larger
    std::string unit;
    double confidence = 0;           ///< probability among all effects
    double explained = 0;            ///< fraction of the chi-square of all differences, including noise
    std::vector<std::string> group;  ///< effects that these data cannot distinguish from it, including itself
    double score = 0;                ///< gain in log likelihood over no effect, nuisances refitted in both
    std::optional<double> confirmed_score;  ///< the same from real runs at the fitted amplitude
};

struct NuisanceFit {
    std::string name;
    double value = 0, error = 0;  ///< shift from the scene's value; one sigma after the fit
    double prior = 0;             ///< one sigma before the fit
    std::string unit;
    bool at_bound = false;  ///< beyond 2.5 sigmas of its prior; of Diagnosis::check_first: at the end of the
                            ///< range that is tried
    double sigmas() const { return prior > 0 ? value / prior : 0; }
};

struct GapReduction {
    std::string held_out;          ///< which part of the data
    double before = 0, after = 0;  ///< gap without noise: sum over cells of squared differences in sigmas
    double fraction = 0;           ///< 1 - after/before
    std::array<double, 2> interval{0, 0};  ///< 90 %
    double placebo = 0;
    std::optional<double> confirmed;  ///< fraction from real runs
    /// Rtop, errf [N], errZ, bhat, as far as known: name; before and after.
    std::vector<std::pair<std::string, std::array<double, 2>>> metrics;
    std::vector<std::array<double, 4>>
        top_force;  ///< displacement [m], experiment, before and after [N], during loading
    /// Interval of the plate's displacement in which the effect was fitted [m]; equal ends: not one interval.
    std::array<double, 2> fitted_displacement{0, 0};
};

/// How much of the gap the named explanation, otherwise the best one, takes away. The verdict depends on it.
struct Explanation {
    double reduction = 0;    ///< fraction of the gap that it takes away
    bool simulated = false;  ///< true: from real runs; false: from signatures
    bool held_out = true;    ///< of the gap in held-out data; false: these show none, so of the whole gap
    double placebo = 0;      ///< reduction by the best of random signatures
    double needed = 0;       ///< reduction that is required to name an effect
    double remainder_p = 1;  ///< p-value of the remainder
    bool leaves_more_than_noise = false;
    std::string without = {};  ///< displacement and phase left out, where grains may have rearranged
    double remainder() const { return 1 - reduction; }
};

/// A numerical setting of the simulation that is consistent with the gap.
struct Refinement {
    std::string effect;  ///< empty: the plate moves as that of the experiment
    std::string key, unit;
    double from = 0, to = 0;
    bool done = false;  ///< the diagnosis refined the scene and continued; otherwise the user must set it
};

/// A recommended next step.
struct NextStep {
    std::string what;
    std::optional<double> power;  ///< probability that it decides, predicted from signatures or runs
};

/// One of several packings that were diagnosed together.
struct PackingAgreement {
    std::string experiment;
    double gap_p = 1;                           ///< p-value of its gap alone
    double amplitude = 0, amplitude_error = 0;  ///< of the leading cause, from this packing alone
    double agreement_p = 1;                     ///< p-value of its difference from the other packings
    bool differs = false;  ///< the difference exceeds noise, corrected for the number of packings
};

/// Something without a value in some bins of the experiment.
struct MissingBins {
    /// An effect: only that effect is not compared there. A parameter, or one of several packings: then
    /// nothing is compared there. Empty: some runs of the unchanged scene, likewise.
    std::string of;
    int count = 0, all = 0;  ///< bins that it lacks, of those that can be compared otherwise
    bool for_all = false;    ///< nothing is compared there
    double share() const { return all > 0 ? static_cast<double>(count) / all : 0; }
};

struct DetectionLimit {
    std::string effect, unit;
    double minimum_amplitude =
        std::numeric_limits<double>::infinity();  ///< infinite: these data cannot show the effect
    double absorbed_by_calibration = 0;           ///< fraction of its signature that nuisances absorb
    std::vector<std::string> group;  ///< effects that cannot be distinguished from it at twice that amplitude
};

struct Diagnosis {
    Verdict verdict = Verdict::no_gap;
    bool detected = false;
    double p_value = 1;  ///< smaller p of the two tests, with Bonferroni correction
    double p_omnibus = 1, p_directed = 1;
    std::vector<WhereEntry> where;
    std::vector<WhereCell> cells;
    std::vector<Cause> causes;           ///< best first; empty without a gap
    std::vector<Cause> ranking;          ///< all candidates by score, for the figure
    std::vector<NuisanceFit> nuisances;  ///< refitted without any effect
    /// Parameters that the explanation, otherwise the best fit without an effect, shifts by more than their
    /// uncertainty allows, the farthest first: all other results assume these shifts.
    std::vector<NuisanceFit> check_first;
    std::optional<Explanation> explanation;  ///< empty without a gap
    std::optional<GapReduction> gap_reduction;
    std::vector<DetectionLimit> detection_limits;
    std::vector<MissingBins> missing_bins;   ///< empty if everything has values in all bins
    std::vector<PackingAgreement> packings;  ///< empty for a single packing
    std::vector<Refinement> refinements;
    std::vector<NextStep> next;             ///< most useful first
    std::vector<std::string> not_measured;  ///< missing data, and what they would show
    std::vector<std::string>
        not_testable;  ///< candidates that this scene or these data cannot show, with reasons
    double seconds = 0;
    std::map<std::string, std::string> provenance;  ///< scene, experiment, program, device, seed
    double where_threshold = 0;  ///< |z| above which a cell is significant among all cells; 0: unknown
};

}  // namespace mcdem::diagnose
