#include "ensemble/diagnose_experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <numeric>

#include "core/errors.h"
#include "ensemble/library_origin.h"
#include "ensemble/paper_metrics.h"
#include "experiment/check_experiment.h"

namespace mcdem {
namespace {

/// The part of a diagnosis' work that one stage is.
TrialOptions stage(const DiagnoseOptions& options, const std::string& name) {
    TrialOptions trial_options;
    trial_options.on_progress = [&options, name](double fraction) { options.on_progress(name, fraction); };
    trial_options.stop_wanted = options.stop_wanted;
    return trial_options;
}

void expect_library_of(const Library& library, const Grid& grid, const LibraryPlan& plan,
                       const std::filesystem::path& file) {
    std::vector<std::string> problems;
    const auto expect = [&](const std::vector<Signature>& list, const std::string& name) {
        if (std::ranges::find(list, name, &Signature::name) == list.end())
            problems.push_back(fmt::format(
                "{}: has no signature of {}: give another file, which is made where it is missing, or leave "
                "{} out of --candidates",
                file.string(), name, name));
    };
    for (const std::string& name : plan.candidates) expect(library.effects, name);
    for (const Nuisance& nuisance : plan.nuisances) expect(library.nuisances, nuisance.name);
    constexpr double alike = 0.1;  // a shifted zero of strain is for the diagnosis to find
    if (std::abs(library.grid.stroke - grid.stroke) > alike * grid.stroke)
        problems.push_back(fmt::format("{}: was made for a stroke of {:.4g} mm, the experiment has {:.4g} mm",
                                       file.string(), 1e3 * library.grid.stroke, 1e3 * grid.stroke));
    if (!problems.empty()) throw InputError(problems);
}

/// Whole recordings that the paper's metrics are taken from, on either side.
constexpr std::size_t recordings_kept = 4;

/// Real runs of a proposal, and again with what they taught.
constexpr int most_rounds = 3;

/// The work of one diagnosis, in the order of its steps.
class Diagnosing {
public:
    Diagnosing(Device& device, const Scene& scene, const Experiment& experiment,
               const DiagnoseOptions& options)
        : device_(device),
          experiment_(experiment),
          options_(options),
          store_(options.folder / "simulations"),
          model_(model_of(scene, experiment)),
          choice_(choose_candidates(model_, options.candidates)) {
        question_ = {scene, grid_of(experiment.recording), reference_material(model_),
                     model_.replica.protocol.discard, options.program};
        plan_ = {{start_packing(experiment)},
                 options.replicates,
                 options.pairs,
                 experiment.measurement.position_error,
                 experiment.measurement.diameter_error,
                 options.seed,
                 choice_.chosen,
                 nuisances(model_, experiment)};
    }

    Diagnosis all() {
        Evidence evidence = gather();
        options_.on_evidence(evidence);
        Draft draft(evidence, options_.limits);
        if (options_.confirmations > 0 && draft.decision().verdict != Verdict::no_gap) confirm(draft);
        options_.on_findings(draft.findings());
        Diagnosis diagnosis = draft.diagnosis();
        diagnosis.not_testable = choice_.hindered;
        if (diagnosis.shrink && options_.paper_metrics && options_.confirmations > 0)
            add_paper_metrics(*diagnosis.shrink, experiment_.recording, before_after(draft));
        return diagnosis;
    }

private:
    Evidence gather() {
        Evidence evidence;
        evidence.seed = options_.seed;
        const bool ready = options_.library && std::filesystem::exists(*options_.library);
        if (ready) {  // before any work
            evidence.library = read_library(*options_.library);
            expect_origin(evidence.library, library_origin(question_, model_, plan_.packings.front().size()),
                          *options_.library);
            expect_library_of(evidence.library, question_.grid, plan_, *options_.library);
        }
        if (options_.paper_metrics)
            recorded(baseline_trials(model_, plan_));  // first: what is kept whole is not simulated again
        if (ready) {
            question_.grid = evidence.library.grid;
            evidence.baseline = observe_trials(device_, question_, baseline_trials(model_, plan_), store_,
                                               stage(options_, "baseline"));
        } else {
            evidence.library =
                build_library(device_, question_, model_, plan_, store_, stage(options_, "library"));
            evidence.baseline = evidence.library.baseline;
            if (options_.library) write_library(*options_.library, evidence.library);
        }
        evidence.observed =
            observe(experiment_.recording, question_.grid, question_.material, question_.discard);
        for (const std::string& name : choice_.chosen) {
            const Effect& effect = *find_effect(name);
            const double scale = effect.scale(model_);
            evidence.candidates.push_back(
                {name, std::string(effect.unit), effect.low * scale, effect.high * scale});
        }
        for (const Nuisance& nuisance : plan_.nuisances)
            evidence.nuisances.push_back({nuisance.name, nuisance.unit, nuisance.sigma});
        for (const std::string& note : leave_out_failures(evidence)) {
            options_.on_note(note);
            choice_.hindered.push_back(note);
        }
        return evidence;
    }

    /// Real runs of every proposal, again where they miss; then of the one decided on with what the fitted
    /// part of the data says of it.
    void confirm(Draft& draft) {
        std::vector<std::size_t> tried(draft.findings().proposals.size());
        std::iota(tried.begin(), tried.end(), std::size_t{0});
        for (int round = 0; round < most_rounds && !tried.empty(); ++round) {
            run(draft, tried);
            std::erase_if(tried, [&](std::size_t k) { return !draft.refit(k); });
        }
        while (const auto k = draft.wants_held_out()) {
            const std::vector<Trial> trials = held_out_trials(draft, *k);
            if (options_.paper_metrics) recorded(trials);
            draft.confirm_held_out(*k, observe_trials(device_, question_, trials, store_,
                                                      stage(options_, "held-out confirmation")));
        }
    }

    void run(Draft& draft, const std::vector<std::size_t>& proposals) {
        std::vector<Trial> trials;
        for (const std::size_t k : proposals)
            append(trials, trials_of(draft, draft.findings().proposals[k], draft.whole_fit(k)));
        const Eigen::MatrixXd runs =
            observe_trials(device_, question_, trials, store_, stage(options_, "confirmation"));
        for (std::size_t k = 0; k < proposals.size(); ++k)
            draft.confirm(proposals[k], runs.middleRows(static_cast<Eigen::Index>(k) * options_.confirmations,
                                                        options_.confirmations));
    }

    BeforeAfter before_after(const Draft& draft) {
        LibraryPlan plan = plan_;
        plan.replicates = std::min(options_.replicates, options_.confirmations);
        return {
            kept_recordings(device_, question_, recorded(baseline_trials(model_, plan)), store_),
            kept_recordings(device_, question_, recorded(held_out_trials(draft, draft.decided())), store_)};
    }

    /// The first few trials, with their whole recordings kept.
    std::vector<Trial> recorded(std::vector<Trial> trials) const {
        trials.resize(std::min<std::size_t>(trials.size(), recordings_kept));
        for (Trial& trial : trials) trial.keep_recording = true;
        observe_trials(device_, question_, trials, store_, stage(options_, "recordings"));
        return trials;
    }

    static void append(std::vector<Trial>& all, std::vector<Trial> more) {
        all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
    }

    std::vector<Trial> trials_of(const Draft& draft, const Proposal& proposal, const PartialFit& fit) const {
        LibraryPlan plan = plan_;
        plan.replicates = options_.confirmations;
        return baseline_trials(fitted(draft.data(), proposal, fit), plan);
    }

    std::vector<Trial> held_out_trials(const Draft& draft, std::size_t proposal) const {
        return trials_of(draft, draft.findings().proposals[proposal], draft.part_fit(proposal));
    }

    /// The model with the fitted effects and nuisances.
    Model fitted(const GapData& data, const Proposal& proposal, const PartialFit& fit) const {
        Model model = model_;
        Eigen::VectorXd shifts = fit.nuisances;
        for (std::size_t k = 0; k < proposal.candidates.size(); ++k) {
            const std::string& name = data.name(proposal.candidates[k]);
            if (static_cast<int>(proposal.candidates[k]) < data.effects)
                find_effect(name)->apply(model, fit.amplitudes[k]);
            else
                shifts[std::ranges::find(plan_.nuisances, name, &Nuisance::name) - plan_.nuisances.begin()] +=
                    fit.amplitudes[k];
        }
        for (Eigen::Index k = 0; k < shifts.size(); ++k)
            plan_.nuisances[static_cast<std::size_t>(k)].apply(model, shifts[k]);
        return model;
    }

    Device& device_;
    const Experiment& experiment_;
    const DiagnoseOptions& options_;
    ObservationStore store_;
    Model model_;
    CandidateChoice choice_;
    Question question_;
    LibraryPlan plan_;
};

}  // namespace

Packing start_packing(const Experiment& experiment) {
    const Recording& recording = experiment.recording;
    if (recording.scans.empty() || recording.scans.front().position.empty())
        throw InputError(
            fmt::format("{}: grains.csv must have the positions of frame 0, from which simulations start",
                        experiment.name));
    return {recording.scans.front().position, recording.diameter};
}

Model model_of(const Scene& scene, const Experiment& experiment) {
    const Recording& recording = experiment.recording;
    Model model;
    model.replica = scene.replicas.front();
    model.replica.box = recording.box;
    model.instrument.stated = experiment.measurement;
    model.mean_diameter = std::reduce(recording.diameter.begin(), recording.diameter.end()) /
                          static_cast<double>(std::max<std::size_t>(1, recording.diameter.size()));
    double lowest = recording.plate_start;
    for (const Scan& scan : recording.scans) lowest = std::min(lowest, scan.plate_z);
    // A scan before the stroke is no level of it, even where the plate's zero is a little off.
    const double begun = 0.02 * (recording.plate_start - lowest);
    int loading = 0, cycles = 1;
    for (const Scan& scan : recording.scans) {
        loading +=
            scan.cycle == 0 && scan.phase == Phase::load && recording.displacement(scan) > begun ? 1 : 0;
        cycles = std::max(cycles, scan.cycle + 1);
    }
    if (loading == 0 || !(lowest < recording.plate_start))
        throw InputError(
            fmt::format("{}: plate.csv must have loading frames below plate.start", experiment.name));
    model.replica.plate.start = recording.plate_start;
    model.replica.plate.end = lowest;
    model.replica.protocol.scans_per_stroke = loading;
    model.replica.protocol.cycles =
        std::min(cycles, std::max(model.replica.protocol.cycles, model.replica.protocol.discard + 1));
    model.replica.protocol.scan_at_start = true;
    return model;
}

Diagnosis diagnose_experiment(Device& device, const Scene& scene, const Experiment& experiment,
                              const DiagnoseOptions& options) {
    if (const auto needed = needed_to_diagnose(experiment); !needed.empty()) throw InputError(needed);
    const auto begin = std::chrono::steady_clock::now();
    Diagnosis diagnosis = Diagnosing(device, scene, experiment, options).all();
    diagnosis.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    diagnosis.provenance = {{"scene", scene.name},
                            {"experiment", experiment.name},
                            {"program", options.program},
                            {"device", device.description()},
                            {"seed", std::to_string(options.seed)}};
    return diagnosis;
}

}  // namespace mcdem
