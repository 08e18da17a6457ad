#include "diagnose/diagnosis_samples.h"

#include <cmath>
#include <random>

namespace mcdem::samples {
namespace {

constexpr std::array observables{
    "top_force",           "floor_force",      "side_force",          "plate_couple_x",   "plate_couple_y",
    "coordination_number", "weak_contacts",    "mean_force",          "force_spread",     "weak_forces",
    "strong_forces",       "force_anisotropy", "vertical_gradient",   "non_affine",       "attraction",
    "friction_ratio",      "friction_high",    "wall_friction_ratio", "torque_imbalance", "gap_contacts",
    "overlap_offset",      "overlap_slope",    "overlap_curvature",   "cross_contact",    "grain_scatter"};
constexpr std::array displacements{6e-3, 12e-3, 18e-3, 24e-3, 30e-3};

struct Candidate {
    const char* effect;
    const char* unit;
    double limit;  ///< smallest detectable amplitude
    double absorbed;
};
constexpr double never = std::numeric_limits<double>::infinity();
constexpr std::array<Candidate, 18> candidates{{
    {"adhesion", "J/m2", 8e-5, 0.12},
    {"bulge_contacts", "", 0.15, 0.31},
    {"friction", "", 0.012, 0.2},
    {"wall_friction", "", 0.02, 0.05},
    {"friction_history", "", 0.4, 0.08},
    {"viscoelasticity", "", 0.03, 0.1},
    {"stiffening", "", 0.25, 0.64},
    {"plasticity", "", 0.02, 0.22},
    {"buoyancy", "kg/m3", 4, 0.02},
    {"diameter_error", "m", 5e-5, 0.85},
    {"polydispersity", "m", 8e-5, 0.07},
    {"modulus_scatter", "", 0.08, 0.04},
    {"rolling_resistance", "", never, 0},
    {"plate_tilt", "", 0.004, 0.01},
    {"plate_compliance", "m/N", 2e-5, 0.93},
    {"force_bias", "relative", 0.02, 0.97},
    {"force_threshold", "N", 1e-3, 0.3},
    {"position_bias", "relative", never, 1},
}};

/// Fraction of an effect in each observable.
double signature(std::size_t observable, bool unload, double displacement) {
    const double strength = 7 * std::sin(2.3 * double(observable)) * std::exp(-0.25 * double(observable % 6));
    return strength * (unload ? 1.0 : 0.55) * std::sqrt(displacement / 30e-3);
}

void add_cells(Diagnosis& d, double strength, double left) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> noise;
    d.where_threshold = 3.9;
    for (std::size_t o = 0; o < observables.size(); ++o)
        for (const char* phase : {"load", "unload"})
            for (const double displacement : displacements) {
                const double shape = signature(o, std::string(phase) == "unload", displacement);
                const double scatter = noise(random);
                d.cells.push_back({observables[o], phase, displacement, strength * shape + scatter,
                                   left * shape + scatter});
                const auto& cell = d.cells.back();
                if (std::fabs(cell.z_score) >= d.where_threshold)
                    d.where.push_back({cell.observable,
                                       phase,
                                       {displacement - 3e-3, displacement + 3e-3},
                                       {},
                                       {},
                                       cell.z_score,
                                       cell.z_score_refitted});
            }
}

void add_ranking(Diagnosis& d, double best_score, double probability, double explained) {
    for (std::size_t c = 0; c < candidates.size(); ++c) {
        const auto& known = candidates[c];
        const double fall = std::exp(-0.45 * double(c));
        const double limit = std::isfinite(known.limit) ? known.limit : 0.01;
        d.ranking.push_back({.effect = known.effect,
                             .amplitude = limit * (c % 5 == 3 ? -1 : 1) * (0.3 + 3 * fall),
                             .amplitude_error = limit * (0.3 + 0.05 * double(c)),
                             .unit = known.unit,
                             .confidence = probability * std::exp(-2.2 * double(c)),
                             .explained = explained * fall,
                             .group = {known.effect},
                             .score = best_score * fall,
                             .confirmed_score = {}});
        d.detection_limits.push_back({known.effect, known.unit, known.limit, known.absorbed, {known.effect}});
    }
    for (const std::size_t c : {9u, 14u, 15u})
        for (auto* group : {&d.ranking[c].group, &d.detection_limits[c].group})
            *group = {"diameter_error", "plate_compliance", "force_bias"};
}

void add_calibration(Diagnosis& d) {
    d.nuisances = {{"modulus", 180, 120, 500, "Pa", false},
                   {"gamma", -0.021, 0.014, 0.05, "", false},
                   {"friction", 0.003, 0.004, 0.01, "", false},
                   {"strain_offset", 1.2e-4, 0.6e-4, 3e-4, "m", false}};
}

void add_gap_reduction(Diagnosis& d, double fraction) {
    GapReduction gap_reduction{.held_out = "unloading, and loading above 18 mm",
                               .before = 412.6,
                               .after = 412.6 * (1 - fraction),
                               .fraction = fraction,
                               .interval = {fraction - 0.15, fraction + 0.12},
                               .placebo = 0.12,
                               .confirmed = fraction - 0.02,
                               .metrics = {{"Rtop", {0.874, 0.991}},
                                           {"errf", {0.812, 0.143}},
                                           {"errZ", {0.421, 0.187}},
                                           {"bhat", {0.0312, 0.0089}}},
                               .top_force = {},
                               .fitted_displacement = {0, 18e-3}};
    for (int i = 0; i <= 20; ++i) {
        const double s = i * 1.5e-3, strain = std::max(0.0, s - 4e-3) / 26e-3;
        const double measured = 15 * std::pow(strain, 1.5) - 0.35 * strain;
        const double before = 13.1 * std::pow(strain, 1.5);
        gap_reduction.top_force.push_back({s, measured, before, before + fraction * (measured - before)});
    }
    d.gap_reduction = gap_reduction;
}

void explain(Diagnosis& d, double reduction) {
    d.explanation = Explanation{.reduction = reduction,
                                .simulated = true,
                                .held_out = true,
                                .placebo = 0.12,
                                .needed = 0.6,
                                .remainder_p = 2e-6,
                                .leaves_more_than_noise = true};
    add_gap_reduction(d, reduction + 0.02);
}

Diagnosis common() {
    Diagnosis d;
    d.not_measured = {
        "forces on the side walls: would tell friction at the walls from friction between grains",
        "diameters of single grains: would tell their scatter from that of moduli"};
    d.not_testable = {"cross_contact: the scene's contact model has it already",
                      "asphericity: grains are spheres"};
    d.seconds = 1834.2;
    d.provenance = {
        {"scene", "hydrogel.toml"},
        {"experiment", "packing_1"},
        {"program", "mcdem 0.1.0"},
        {"device", "pthread-CPU"},
        {"seed", "17"},
        {"experiment_sha256", "5f70bf18a086007016e948b04aed3b82103a36bea41755b6cddfaf10ace3c6ef"}};
    add_calibration(d);
    d.next = {{"measure 3 more packings and diagnose each, to distinguish adhesion from friction", 0.83},
              {"press a second cycle", {}}};
    return d;
}

}  // namespace

Diagnosis diagnosis(Verdict verdict) {
    auto d = common();
    d.verdict = verdict;
    d.detected = verdict != Verdict::no_gap;
    d.p_omnibus = d.detected ? 0.013 : 0.61, d.p_directed = d.detected ? 0.002 : 0.22;
    d.p_value = d.detected ? 0.004 : 0.44;
    switch (verdict) {
        case Verdict::no_gap:
            add_cells(d, 0, 0);
            add_ranking(d, 1.8, 0.2, 0.01);
            return d;
        case Verdict::effect:
            add_cells(d, 1, 0.8);
            add_ranking(d, 46.3, 0.87, 0.78);
            d.ranking.front().confirmed_score = 44.1;
            d.packings = {{"packing_1", 0.003, 2.6e-4, 3e-5, 0.31, false},
                          {"packing_2", 0.02, 2.2e-4, 3e-5, 0.31, false}};
            explain(d, 0.79);
            d.missing_bins = {{"friction", 4, 8, false}, {"modulus", 1, 9, true}};
            break;
        case Verdict::group:
            add_cells(d, 0.8, 0.6);
            add_ranking(d, 18.2, 0.42, 0.71);
            for (const std::size_t c : {0u, 1u, 2u}) {
                d.ranking[c].group = d.detection_limits[c].group = {"adhesion", "bulge_contacts", "friction"};
                d.ranking[c].score = 18.2 - 0.4 * double(c),
                d.ranking[c].confidence = 0.37 - 0.06 * double(c);
            }
            explain(d, 0.64);
            break;
        case Verdict::unknown_effect:
            add_cells(d, 1.2, 1.1);
            add_ranking(d, 12.4, 0.35, 0.21);
            explain(d, 0.07);
            break;
        case Verdict::not_converged:
            add_cells(d, 0.9, 0.7);
            add_ranking(d, 30, 0.8, 0.5);
            d.ranking.front().effect = "plate_speed";
            d.ranking.front().unit = "";
            d.ranking.front().group = {"plate_speed"};
            d.refinements = {{"plate_speed", "plate.speed", "m/s", 0.1, 0.025, true},
                             {"plate_speed", "plate.speed", "m/s", 0.025, 0.0125, false}};
            explain(d, 0.85);
            break;
        case Verdict::calibration_suspect:
            add_cells(d, 0.9, 0.05);
            add_ranking(d, 2.1, 0.3, 0.04);
            d.nuisances[0] = {"modulus", 2300, 200, 500, "Pa", true};
            explain(d, 0.90);
            return d;
    }
    d.causes.assign(d.ranking.begin(), d.ranking.begin() + (verdict == Verdict::group ? 3 : 1));
    return d;
}

Diagnosis with_texts(Diagnosis d, const std::string& text) {
    for (auto& entry : d.where) entry.observable = text, entry.region = text, entry.force_class = text;
    for (auto& cell : d.cells)
        if (cell.observable == "top_force") cell.observable = text;
    for (auto* causes : {&d.causes, &d.ranking})
        for (auto& cause : *causes) cause.effect = cause.unit = text, cause.group = {text, text};
    for (auto* fits : {&d.nuisances, &d.check_first})
        for (auto& fit : *fits) fit.name = fit.unit = text;
    for (auto& missing : d.missing_bins) missing.of = text;
    for (auto& limit : d.detection_limits) limit.effect = limit.unit = text, limit.group = {text, text};
    for (auto& step : d.next) step.what = text;
    for (auto& packing : d.packings) packing.experiment = text;
    for (auto& refinement : d.refinements) refinement.effect = refinement.key = refinement.unit = text;
    for (auto* list : {&d.not_measured, &d.not_testable}) *list = {text};
    if (d.gap_reduction) d.gap_reduction->held_out = text, d.gap_reduction->metrics.push_back({text, {1, 2}});
    d.provenance[text] = text;
    return d;
}

}  // namespace mcdem::samples
