#include "ensemble/diagnosis/diagnose_experiment.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <numeric>

#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/look.h"
#include "ensemble/diagnosis/change_of_the_scene.h"
#include "ensemble/diagnosis/library_origin.h"
#include "ensemble/diagnosis/other_protocols.h"
#include "ensemble/diagnosis/paper_metrics.h"
#include "ensemble/diagnosis/plate_motion.h"
#include "ensemble/parts/library_parts.h"
#include "scene/programme/programme_text.h"
#include "scene/read/keys.h"

namespace mcdem::inline ensemble {
namespace {

/// Options of one stage of a diagnosis.
TrialOptions stage(const DiagnoseOptions& options, const std::string& name) {
    TrialOptions trial_options;
    trial_options.on_progress = [&options, name](double fraction) { options.on_progress(name, fraction); };
    trial_options.stop_wanted = options.stop_wanted;
    return trial_options;
}

/// Maximum number of rounds of real runs of a proposal, including the corrected ones.
constexpr int max_rounds = 3;

/// Largest factor by which a refinement of a numerical setting is recommended.
constexpr double max_refinement = 64;

/// Largest factor by which the plate of an experiment may be slower than that of the scene if its motion is
/// to be simulated. With rate_tolerance the plate of the scene is mostly slower than its maximum, and the
/// runs take less than this factor longer.
constexpr double max_slowdown = 20;

/// The steps of one diagnosis, in order.
class DiagnosisRunner {
public:
    DiagnosisRunner(Device& device, DiagnosisPlan plan, const DiagnoseOptions& options)
        : device_(device),
          experiments_(std::move(plan.experiments)),
          options_(options),
          store_(options.folder / "simulations"),
          choice_(std::move(plan.choice)),
          common_(std::move(plan.common)),
          plan_(std::move(plan.library)) {}

    Diagnosis run() {
        if (const auto others = other_materials(model().replica, experiments_.front().materials);
            !others.empty())
            options_.on_note(
                fmt::format("experiment.toml states {}, but simulations use the values of the scene; change "
                            "them with --set if the experiment is right",
                            fmt::join(others, ", ")));
        if (!options_.candidates.empty())
            for (const std::string& hindered : choice_.hindered) options_.on_note("not tested: " + hindered);
        Evidence evidence = gather();
        auto builder = std::make_unique<DiagnosisBuilder>(evidence, options_.limits);
        const auto motion = motion_up_to(max_slowdown);
        if (motion && options_.refine > 1 && has_gap(*builder)) {
            builder.reset();
            follow(evidence, *motion);
            builder = std::make_unique<DiagnosisBuilder>(evidence, options_.limits);
        }
        confirm(*builder);
        if (builder->decision().verdict == Verdict::not_converged && options_.refine > 1) {
            const Refinement refinement = refinement_of(*builder, options_.refine);
            builder.reset();
            refine(evidence, refinement);
            builder = std::make_unique<DiagnosisBuilder>(evidence, options_.limits);
            confirm(*builder);
        }
        if (builder->decision().verdict == Verdict::not_converged)
            refinements_.push_back(refinement_of(*builder, max_refinement));
        evidence.finer_baseline =
            mean_over_packings(observe_trials(device_, common_, finer_baseline_trials(plan_), store_,
                                              stage(options_, "half the noise")),
                               packings());
        options_.on_evidence(evidence);
        options_.on_findings(builder->findings());
        Diagnosis diagnosis = builder->diagnosis();
        diagnosis.not_testable = choice_.hindered;
        diagnosis.refinements = refinements_;
        if (diagnosis.verdict == Verdict::group) add_other_protocols(*builder, diagnosis.next);
        const auto left = motion_up_to(max_refinement);
        if (left && diagnosis.verdict != Verdict::no_gap)
            diagnosis.next.insert(diagnosis.next.begin(), simulate_motion(model().replica, *left));
        if (auto first = change_of_the_scene(diagnosis, model(), plan_.nuisances))
            diagnosis.next.insert(diagnosis.next.begin(), *first);
        if (auto check = check_of(diagnosis)) diagnosis.next.insert(diagnosis.next.begin(), *check);
        if (diagnosis.gap_reduction && paper_metrics() && options_.confirmations > 0)
            add_paper_metrics(*diagnosis.gap_reduction, experiments_.front().recording,
                              before_after(*builder));
        return diagnosis;
    }

private:
    Evidence gather() {
        Evidence evidence;
        evidence.seed = options_.seed;
        if (options_.library) remove_temporaries_of(*options_.library);  // left by an interrupted diagnosis
        const bool ready = options_.library && is_there(*options_.library);
        if (ready) {  // before any other work
            evidence.library = read_library(*options_.library);
            expect_origin(evidence.library,
                          library_origin(common_, model(), plan_.packings.front().packing.size()),
                          *options_.library);
            expect_library_of(evidence.library, common_.grid, plan_, *options_.library);
        }
        if (paper_metrics())  // first, because trials with complete recordings are not simulated again
            recorded(baseline_trials(plan_), options_.replicates);
        if (ready) {
            common_.grid = evidence.library.grid;
            take_baseline(evidence, simulated_baseline("baseline"));
            expect_alike_loads(evidence.library, evidence.baseline, *options_.library);
        } else {
            evidence.library = build_library(device_, common_, plan_, store_, library_stage("library"));
            library_is_own_ = true;
            take_baseline(evidence, evidence.library.baseline);
            if (options_.library && !write_library(*options_.library, evidence.library))
                options_.on_note(options_.library->string() +
                                 ": another process wrote this library first; it is kept");
        }
        for (const std::string& name : choice_.chosen) {
            const Effect& effect = *find_effect(name);
            const double scale = effect.scale(model());
            evidence.candidates.push_back(
                {name, std::string(effect.unit), effect.low * scale, effect.high * scale});
            if (name == "plate_speed" && model().experiment_speed)
                evidence.candidates.back().high = 1 - *model().experiment_speed / model().replica.plate.speed;
        }
        for (const Nuisance& nuisance : plan_.nuisances)
            evidence.nuisances.push_back({nuisance.name, nuisance.unit, nuisance.sigma});
        note_failures(evidence);
        return evidence;
    }

    Eigen::MatrixXd simulated_baseline(const std::string& name) {
        return observe_trials(device_, common_, baseline_trials(plan_), store_, library_stage(name));
    }

    /// A stage of trials of the library, whose first ones are the baseline.
    TrialOptions library_stage(const std::string& name) {
        TrialOptions trial_options = stage(options_, name);
        trial_options.on_failure = [this](std::size_t trial, const Failure& failure) {
            causes_.emplace(probe_of_trial(plan_, trial), failure.cause);
        };
        return trial_options;
    }

    /// Runs of the unchanged scene, one packing after the other.
    void take_baseline(Evidence& evidence, const Eigen::MatrixXd& runs) {
        if (library_is_own_) evidence.library.baseline = runs;
        evidence.library_is_own = library_is_own_;
        evidence.packings.clear();
        for (std::size_t p = 0; p < experiments_.size(); ++p)
            evidence.packings.push_back(
                {experiments_[p].name,
                 observe(experiments_[p].recording, common_.grid, common_.material, common_.discard),
                 runs.middleRows(static_cast<Eigen::Index>(p) * plan_.replicates, plan_.replicates)});
        take_means(evidence);
        if (experiments_.size() == 1) evidence.packings.clear();
    }

    static bool has_gap(const DiagnosisBuilder& builder) {
        return builder.decision().verdict != Verdict::no_gap;
    }

    Refinement refinement_of(const DiagnosisBuilder& builder, double most) {
        const std::size_t candidate = builder.decision().group.front();
        const Effect& effect = *find_effect(builder.findings().names[candidate]);
        const NumericalSetting setting = effect.settings(plan_.packings.front().model).front();
        return {std::string(effect.name),
                std::string(setting.key),
                std::string(find_key(setting.key)->unit),
                *setting.value,
                *setting.value / builder.refining_factor(candidate, most),
                false};
    }

    /// Refines a setting of the scene. Signatures are differences of paired runs and are kept; the baseline
    /// is simulated again.
    void refine(Evidence& evidence, Refinement refinement) {
        const Effect& effect = *find_effect(refinement.effect);
        for (LibraryPacking& packing : plan_.packings)
            for (const NumericalSetting& setting : effect.settings(packing.model))
                *setting.value *= refinement.to / refinement.from;
        refinement.done = true;
        refinements_.push_back(refinement);
        options_.on_note(
            fmt::format("the gap is consistent with a simulation that is not converged: continuing with {} = "
                        "{} instead of {}",
                        refinement.key, refinement.to, refinement.from));
        take_baseline(evidence, simulated_baseline("refined baseline"));
        for (Signature& signature : evidence.library.effects)
            if (signature.name == refinement.effect)
                signature = continued_from(signature, 1 - refinement.to / refinement.from);
        note_failures(evidence);
    }

    std::optional<PlateMotion> motion_up_to(double slowdown) const {
        return neglected_motion(model().replica, experiments_.front(), slowdown);
    }

    /// Lets the plate move as that of the experiment. Its speed is then known and no candidate.
    void follow(Evidence& evidence, const PlateMotion& motion) {
        std::string settings;
        for (const Refinement& change : changes(model().replica, motion)) {
            refinements_.push_back(change);
            settings += fmt::format("{}{} = {:.3g}", settings.empty() ? "" : ", ", change.key, change.to);
        }
        options_.on_note(
            fmt::format("there is a gap, and experiment.toml states how the plate moves: continuing with "
                        "that motion ({})",
                        settings));
        for (LibraryPacking& packing : plan_.packings) apply(packing.model.replica, motion);
        if (evidence.candidates.size() > 1)
            std::erase_if(evidence.candidates, [](const auto& c) { return c.name == "plate_speed"; });
        take_baseline(evidence, simulated_baseline("baseline with the experiment's plate"));
        note_failures(evidence);
    }

    void note_failures(Evidence& evidence) {
        for (const std::string& note : leave_out_failures(evidence, causes_)) {
            options_.on_note(note);
            choice_.hindered.push_back(note);
        }
    }

    /// If there is a gap: real runs of every proposal, repeated with corrections; then of the chosen one with
    /// the parameters fitted to the first part of the data.
    void confirm(DiagnosisBuilder& builder) {
        if (options_.confirmations == 0 || !has_gap(builder)) return;
        std::vector<std::size_t> tried(builder.findings().proposals.size());
        std::iota(tried.begin(), tried.end(), std::size_t{0});
        for (int round = 0; round < max_rounds && !tried.empty(); ++round) {
            run(builder, tried);
            std::erase_if(tried, [&](std::size_t k) { return !builder.refit(k); });
        }
        while (const auto k = builder.wants_held_out()) {
            const std::vector<Trial> trials = held_out_trials(builder, *k);
            if (paper_metrics()) recorded(trials, options_.confirmations);
            const Eigen::MatrixXd runs =
                observe_trials(device_, common_, trials, store_, stage(options_, "held-out confirmation"));
            builder.confirm_held_out(*k, mean_over_packings(runs, packings()));
        }
    }

    void run(DiagnosisBuilder& builder, const std::vector<std::size_t>& proposals) {
        std::vector<Trial> trials;
        for (const std::size_t k : proposals)
            append(trials, trials_of(builder, builder.findings().proposals[k], builder.whole_fit(k)));
        const Eigen::MatrixXd runs =
            observe_trials(device_, common_, trials, store_, stage(options_, "confirmation"));
        const Eigen::Index each = options_.confirmations * packings();
        for (std::size_t k = 0; k < proposals.size(); ++k)
            builder.confirm(
                proposals[k],
                mean_over_packings(runs.middleRows(static_cast<Eigen::Index>(k) * each, each), packings()));
    }

    /// Adds the power of other protocols to tell the leading effect from its rival, predicted by runs of
    /// both.
    void add_other_protocols(const DiagnosisBuilder& builder, std::vector<NextStep>& next) {
        const Findings& findings = builder.findings();
        const auto rival = proposal_of_rival(findings, builder.decision());
        if (!rival || options_.confirmations < 2) return;
        const auto name_of = [&](std::size_t proposal) {
            return builder.data().name(findings.proposals[proposal].candidates.front());
        };
        const bool slower = depends_on_speed(name_of(builder.decided())) || depends_on_speed(name_of(*rival));
        for (const OtherProtocol& protocol : other_protocols(common_, model().replica, slower)) {
            const auto runs_of = [&](std::size_t proposal) {
                std::vector<Trial> trials =
                    trials_of(builder, findings.proposals[proposal], builder.whole_fit(proposal));
                for (Trial& trial : trials) protocol.change(trial.model.replica);
                return mean_over_packings(observe_trials(device_, protocol.common, trials, store_,
                                                         stage(options_, "other protocols")),
                                          packings());
            };
            next.push_back({fmt::format("{}, to distinguish {} from {}", protocol.what,
                                        name_of(builder.decided()), name_of(*rival)),
                            builder.power_of({runs_of(builder.decided()), runs_of(*rival)})});
        }
        std::ranges::stable_sort(next, std::greater(), [](const NextStep& s) { return s.power.value_or(0); });
    }

    /// Of the first packing.
    BeforeAfter before_after(const DiagnosisBuilder& builder) {
        const int few = std::min(options_.replicates, options_.confirmations);
        return {kept_recordings(device_, common_, recorded(baseline_trials(plan_), few), store_),
                kept_recordings(device_, common_,
                                recorded(held_out_trials(builder, builder.decided()), options_.confirmations),
                                store_)};
    }

    /// The first few of the `of_a_packing` trials, with complete recordings.
    std::vector<Trial> recorded(std::vector<Trial> trials, int of_a_packing) const {
        trials.resize(std::min(static_cast<std::size_t>(of_a_packing), trials_recorded));
        keep_recordings(trials);
        observe_trials(device_, common_, trials, store_, stage(options_, "recordings"));
        return trials;
    }

    static void append(std::vector<Trial>& all, std::vector<Trial> more) {
        all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
    }

    std::vector<Trial> trials_of(const DiagnosisBuilder& builder, const Proposal& proposal,
                                 const PartialFit& fit) const {
        LibraryPlan plan = plan_;
        plan.replicates = options_.confirmations;
        for (LibraryPacking& packing : plan.packings)
            packing.model = fitted(packing.model, builder.data(), proposal, fit);
        return baseline_trials(plan);
    }

    std::vector<Trial> held_out_trials(const DiagnosisBuilder& builder, std::size_t proposal) const {
        return trials_of(builder, builder.findings().proposals[proposal], builder.part_fit(proposal));
    }

    /// A model with the fitted effects and nuisances.
    Model fitted(Model model, const GapData& data, const Proposal& proposal, const PartialFit& fit) const {
        Eigen::VectorXd shifts = fit.nuisances;
        for (std::size_t k = 0; k < proposal.candidates.size(); ++k) {
            const std::string& name = data.name(proposal.candidates[k]);
            if (static_cast<int>(proposal.candidates[k]) < data.effects)
                find_effect(name)->apply(model, fit.amplitudes[k]);
            else
                shifts[std::ranges::find(plan_.nuisances, name, &Nuisance::name) - plan_.nuisances.begin()] +=
                    fit.amplitudes[k];
        }
        for (Eigen::Index k = 0; k < shifts.size(); ++k) plan_.nuisances[k].apply(model, shifts[k]);
        return model;
    }

    /// The metrics compare levels of strokes.
    bool paper_metrics() const { return options_.paper_metrics && model().replica.programme.empty(); }

    /// The model of the first packing.
    const Model& model() const { return plan_.packings.front().model; }
    int packings() const { return static_cast<int>(experiments_.size()); }

    Device& device_;
    std::vector<Experiment> experiments_;
    const DiagnoseOptions& options_;
    ObservationStore store_;
    CandidateChoice choice_;
    TrialSettings common_;
    LibraryPlan plan_;
    bool library_is_own_ = false;  ///< computed on the experiment's own packings
    std::vector<Refinement> refinements_;
    FailureCauses causes_;
};

}  // namespace

Diagnosis diagnose_experiment(Device& device, const Scene& scene, const std::vector<Experiment>& experiments,
                              const DiagnoseOptions& options) {
    expect_plate(scene, "a diagnosis");
    if (scene.replicas.size() > 1)
        options.on_note(fmt::format("the scene has {} replicas; the first one is diagnosed: {}",
                                    scene.replicas.size(), scene.replicas.front().label));
    const auto begin = std::chrono::steady_clock::now();
    Diagnosis diagnosis = DiagnosisRunner(device, plan_of(scene, experiments, options), options).run();
    diagnosis.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    std::vector<std::string> names;
    for (const Experiment& experiment : experiments) names.push_back(experiment.name);
    diagnosis.provenance = {{"scene", scene.name},
                            {"experiment", fmt::format("{}", fmt::join(names, ", "))},
                            {"program", options.program},
                            {"device", device.description()},
                            {"seed", std::to_string(options.seed)}};
    return diagnosis;
}

}  // namespace mcdem::ensemble
