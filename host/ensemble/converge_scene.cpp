#include "ensemble/converge_scene.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <variant>

#include "core/errors.h"
#include "ensemble/diagnosis/observe_trials.h"
#include "ensemble/make_packings.h"
#include "scene/packing/make_packing.h"
#include "scene/programme/legs.h"

namespace mcdem::inline ensemble {
namespace {

constexpr double jitter_of_diameter = 0.005;

/// One step of a refinement.
struct Step {
    double remaining;  ///< fraction of the error that remains
    std::function<void(Scene& scene, Replica& replica)> refine;
};

struct Plan {
    std::string cause, remedy;
    std::vector<Step> steps;
};

Step slower(double factor) {
    return {factor, [factor](Scene&, Replica& replica) {
                replica.plate.speed *= factor;
                replica.protocol.rate_tolerance *= factor;
                for (Stage& stage : replica.programme) stage.speed *= factor;  // NaN is not changed
            }};
}

std::string speed_remedy(const Replica& replica) {
    if (replica.protocol.rate_tolerance > 0)
        return fmt::format("protocol.rate_tolerance = {:.2g} / {{0:.2g}}, runs {{0:.2g}} times as long",
                           replica.protocol.rate_tolerance);
    return fmt::format(
        "plate.speed = {:.2g} / {{0:.2g}}{}, runs {{0:.2g}} times as long, or set protocol.rate_tolerance, "
        "which slows the plate only when necessary",
        replica.plate.speed, replica.programme.empty() ? "" : " and the speeds of stages likewise");
}

constexpr const char* without_stops =
    "protocol.stop_at_scans = false, with a slow plate: runs then save the time of the stops";

/// Forces depend on inertia through the square root of the density. The error of Verlet is quadratic in the
/// time step, but that of the damping is linear, which is assumed here.
std::vector<Plan> plans_of(const Scene& scene, const Replica& replica) {
    std::vector<Plan> plans;
    plans.push_back({"plate speed", speed_remedy(replica), {slower(0.5), slower(0.25), slower(0.125)}});
    plans.push_back({"inertia",
                     fmt::format("grains.density = {:.3g} / {{1:.2g}}, runs {{0:.2g}} times as long",
                                 replica.grains.density),
                     {{0.5, [](Scene&, Replica& r) { r.grains.density /= 4; }}}});
    plans.push_back({"time step",
                     fmt::format("numerics.time_step = {:.2g} / {{0:.2g}}, runs {{0:.2g}} times as long",
                                 replica.numerics.time_step),
                     {{0.5, [](Scene&, Replica& r) { r.numerics.time_step /= 2; }}}});
    if (replica.protocol.stop_at_scans)
        plans.push_back({"settling",
                         without_stops,
                         {{0,
                           [](Scene&, Replica& r) {
                               r.protocol.settle_unbalanced_force /= 10;
                               r.protocol.settle_time *= 4;
                           }}}}),
            plans.push_back({"stops at scans", without_stops, {{0, [](Scene&, Replica& r) {
                                                                    r.protocol.stop_at_scans = false;
                                                                }}}});
    if (scene.precision == Precision::single_precision)
        plans.push_back({"precision",
                         "numerics.precision = double, runs twice as long",
                         {{0, [](Scene& s, Replica&) { s.precision = Precision::double_precision; }}}});
    plans.push_back({"list margin", "", {{0, [](Scene&, Replica& r) { r.numerics.skin *= 1.25; }}}});
    return plans;
}

class Converging {
public:
    Converging(Device& device, const Scene& scene, const ConvergeOptions& options)
        : device_(device), scene_(scene), options_(options), store_(options.folder / "simulations") {
        const Replica& replica = scene.replicas.front();
        packings_.assign(static_cast<std::size_t>(options.replicas), make_packing(replica));
        for (const double diameter : packings_[0].diameter)
            mean_diameter_ += diameter / static_cast<double>(packings_[0].size());
        grid_ = replica.programme.empty() ? grid_of_stroke(replica) : grid_of_programme();
    }

    Convergence all() {
        const auto start = std::chrono::steady_clock::now();
        std::string copies = "jittered copies of one packing";
        Eigen::MatrixXd base = observe("the scene as it stands", scene_, scene_.replicas.front());
        expect_enough(base);
        if (hardly_differ(base) && options_.jitter == 0) {
            if (can_draw_anew()) {
                draw_anew();
                copies = "new random packings, because jittered copies of one hardly differ";
                base = observe("new random packings", scene_, scene_.replicas.front());
                expect_enough(base);
            } else {
                copies +=
                    ", which hardly differ; a packing.file has no random copies: a larger --jitter makes "
                    "them";
            }
        }
        std::vector<RefinedRuns> refinements;
        for (const Plan& plan : plans_of(scene_, scene_.replicas.front())) {
            RefinedRuns refinement{plan.cause, plan.remedy, {}, {}};
            for (const Step& step : plan.steps) {
                Scene scene = scene_;
                Replica replica = scene_.replicas.front();
                step.refine(scene, replica);
                refinement.remaining.push_back(step.remaining);
                refinement.observed.push_back(observe(plan.cause, scene, replica));
            }
            refinements.push_back(std::move(refinement));
        }
        Convergence result = convergence_of(grid_, base, refinements, options_.limits);
        result.scene = scene_.name;
        result.copies = copies;
        result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return result;
    }

private:
    /// The grid of a diagnosis of an experiment with this scene's stroke.
    static Grid grid_of_stroke(const Replica& replica) {
        Recording levels;
        levels.plate_start = replica.plate.start;
        const int scans = replica.protocol.scans_per_stroke;
        for (int k = 1; k <= scans; ++k) {
            Scan scan;
            scan.plate_z = replica.plate.start + (replica.plate.end - replica.plate.start) * k / scans;
            levels.scans.push_back(scan);
        }
        return grid_of(levels);
    }

    /// The same for an experiment that follows the first copy.
    Grid grid_of_programme() {
        const Replica& replica = scene_.replicas.front();
        Trial trial = trial_of(replica, 0, 0);
        trial.keep_recording = true;
        const TrialSettings common = trial_settings_of(scene_, trial.model);
        observe_trials(device_, common, {trial}, store_, trial_options("the programme's displacements"));
        const Recording recording = kept_recordings(device_, common, {trial}, store_).front();
        if (recording.failure || recording.scans.empty())
            throw InputError(fmt::format(
                "{}: the first replica does not come to the end of the programme: `mcdem run` with the same "
                "settings says why",
                scene_.name));
        return grid_of(recording);
    }

    Trial trial_of(const Replica& replica, int copy, double jitter) const {
        Model model{replica, {}, mean_diameter_};
        model.instrument.stated.force_threshold = replica.protocol.force_threshold;
        return {model, packings_[copy], jitter, 0, options_.seed + static_cast<std::uint64_t>(copy)};
    }

    TrialSettings trial_settings_of(const Scene& scene, const Model& model) const {
        return {scene, grid_, reference_material(model), model.replica.protocol.discard, options_.program};
    }

    TrialOptions trial_options(const std::string& cause) const {
        return {[this, cause](double fraction) { options_.on_progress(cause, fraction); },
                options_.stop_wanted};
    }

    Eigen::MatrixXd observe(const std::string& cause, const Scene& scene, const Replica& replica) {
        const double jitter = options_.jitter > 0 ? options_.jitter : jitter_of_diameter * mean_diameter_;
        std::vector<Trial> trials;
        for (int r = 0; r < options_.replicas; ++r) trials.push_back(trial_of(replica, r, jitter));
        return observe_trials(device_, trial_settings_of(scene, trials.front().model), trials, store_,
                              trial_options(cause));
    }

    /// Whether the replicas are nearly identical: copies without rearrangements scatter less than the
    /// resolution of the observables.
    bool hardly_differ(const Eigen::MatrixXd& base) const {
        const Convergence scatter = convergence_of(grid_, base, {}, options_.limits);
        int known = 0, differ = 0;
        for (std::size_t c = 0; c < scatter.cells.size(); ++c) {
            const double deviation = scatter.deviation[static_cast<Eigen::Index>(c)];
            known += std::isfinite(deviation) ? 1 : 0;
            differ += deviation >= scatter.scale(c) ? 1 : 0;
        }
        return 2 * differ < known;
    }

    bool can_draw_anew() const {
        return std::holds_alternative<GeneratedPacking>(scene_.replicas.front().packing.source);
    }

    void draw_anew() {
        Scene all = scene_;
        all.replicas.assign(packings_.size(), scene_.replicas.front());
        for (std::size_t r = 0; r < packings_.size(); ++r) all.replicas[r].packing.seed += r;
        packings_ = make_packings(all, options_.stop_wanted);
    }

    void expect_enough(const Eigen::MatrixXd& base) const {
        const auto runs = (base.col(0).array() == base.col(0).array()).count();
        if (runs >= 4) return;
        throw InputError(
            fmt::format("{}: {} of {} replicas reach the first compared displacement with a force on the "
                        "plate, and 4 are needed: `mcdem run` with the same settings says why",
                        scene_.name, runs, options_.replicas));
    }

    Device& device_;
    const Scene& scene_;
    const ConvergeOptions& options_;
    ObservationStore store_;
    std::vector<Packing> packings_;  ///< by replica
    double mean_diameter_ = 0;
    Grid grid_;
};

}  // namespace

Convergence converge_scene(Device& device, const Scene& scene, const ConvergeOptions& options) {
    expect_plate(scene, "mcdem converge");
    return Converging(device, scene, options).all();
}

}  // namespace mcdem::ensemble
