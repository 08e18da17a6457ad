#include "ensemble/diagnosis/observe_trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <numeric>
#include <optional>

#include "core/in_parallel.h"
#include "core/random.h"
#include "core/sha256.h"
#include "ensemble/make_packings.h"
#include "scene/packing/make_packing.h"
#include "scene/packing/neighbour_slots.h"
#include "scene/programme/programme_text.h"
#include "scene/read/keys.h"

namespace mcdem::inline ensemble {
namespace {

constexpr std::size_t max_grains_at_once = 32'768;
constexpr std::size_t max_grains_of_a_part = 8'192;  // less, so that every process gets some

/// What the simulation of a trial is made of.
std::string simulation_name(const std::string& device, const TrialSettings& common, const Trial& trial) {
    Sha256 digest;
    digest.add(common.program).add(device).add(name(common.scene.precision));
    Settings settings;
    settings.replica = trial.model.replica;
    for (const Key& key : keys())
        if (key.scope == Scope::replica && !is_generator_key(key.name) && key.name != "packing.file" &&
            key.name != "packing.frame")
            digest.add(key.name).add("=").add(value_text(key, settings)).add("\n");
    for (const auto& [key, value] : programme_parameters(trial.model.replica.programme))
        digest.add(key).add("=").add(parameter_text(value)).add("\n");
    for (const Vec3& position : trial.packing.position) digest.add(std::span(position.data(), 3));
    digest.add(trial.packing.diameter);
    for (const auto* vectors : {&trial.packing.velocity, &trial.packing.angular_velocity})
        for (const Vec3& vector : *vectors) digest.add(std::span(vector.data(), 3));
    for (const TangentialForce& one : trial.packing.tangential)
        digest.add(fmt::format("{} {}", one.grain, one.partner)).add(std::span(one.force.data(), 3));
    const double jitter[] = {trial.jitter, trial.diameter_jitter};
    return digest.add(jitter).add(std::to_string(trial.seed)).hex();
}

/// The members of a type that has only real numbers.
template <class Numbers>
auto members_of(const Numbers& numbers) {
    static_assert(sizeof(Numbers) % sizeof(double) == 0);
    return std::bit_cast<std::array<double, sizeof(Numbers) / sizeof(double)>>(numbers);
}

std::string observation_name(const std::string& simulation, const TrialSettings& common,
                             const Instrument& instrument) {
    const Grid& grid = common.grid;
    const double widths[] = {grid.width, grid.force_width, static_cast<double>(common.discard)};
    Sha256 digest;
    digest.add(simulation).add(members_of(instrument)).add(members_of(common.material)).add(widths);
    digest.add(grid.displacement).add(grid.force);
    for (const HoldScans& hold : grid.holds)
        digest.add(fmt::format("{}-{}-{} at {};", hold.begin, hold.first, hold.end, hold.displacement));
    for (const Observable& observable : observables()) digest.add(observable.name).add(";");
    return digest.hex();
}

/// The trials that share one simulation.
using Job = std::vector<std::size_t>;

/// Of these trials, by the names of their simulations.
std::vector<Job> jobs_of(const std::vector<std::size_t>& trials,
                         const std::vector<std::string>& simulations) {
    std::map<std::string, std::size_t> job_of;
    std::vector<Job> jobs;
    for (const std::size_t t : trials) {
        const auto [place, is_new] = job_of.emplace(simulations[t], jobs.size());
        if (is_new) jobs.emplace_back();
        jobs[place->second].push_back(t);
    }
    return jobs;
}

/// Jobs that a device does at a time.
std::vector<std::vector<Job>> batches_of(const std::vector<Job>& jobs, const std::vector<Trial>& trials,
                                         std::size_t max_grains) {
    std::vector<std::vector<Job>> batches;
    std::size_t grains = max_grains;
    for (const Job& job : jobs) {
        if (grains >= max_grains) {
            batches.emplace_back();
            grains = 0;
        }
        batches.back().push_back(job);
        grains += trials[job.front()].packing.size();
    }
    return batches;
}

std::vector<std::size_t> numbers_of(const std::vector<Trial>& trials) {
    std::vector<std::size_t> numbers(trials.size());
    std::iota(numbers.begin(), numbers.end(), std::size_t{0});
    return numbers;
}

class Work {
public:
    Work(Device& device, const TrialSettings& common, const std::vector<Trial>& trials,
         const ObservationStore& store, const Callbacks& callbacks)
        : device_(device),
          common_(common),
          trials_(trials),
          store_(store),
          callbacks_(callbacks),
          names_(trials.size()),
          result_(Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(trials.size()),
                                            static_cast<Eigen::Index>(bins_of(common.grid).size()),
                                            unknown)) {}

    Eigen::MatrixXd all() {
        for (std::size_t t = 0; t < trials_.size(); ++t) {
            simulations_.push_back(simulation_name(device_.description(), common_, trials_[t]));
            names_[t] = observation_name(simulations_[t], common_, trials_[t].model.instrument);
        }
        simulate_missing();
        return std::move(result_);
    }

private:
    /// Trials whose observations (and recordings, where wanted) the store has are filled in; the others go to
    /// `left`.
    std::vector<std::size_t> take_from_store(const std::vector<std::size_t>& trials) {
        std::vector<std::size_t> left;
        for (const std::size_t t : trials) {
            const bool lacks_recording = trials_[t].keep_recording && !store_.has_recording(names_[t]);
            const auto kept = lacks_recording ? std::nullopt : store_.find(names_[t]);
            if (kept && kept->size() == result_.cols())
                result_.row(static_cast<Eigen::Index>(t)) = *kept;
            else
                left.push_back(t);
        }
        return left;
    }

    void simulate_missing() {
        const std::vector<Job> jobs = jobs_of(take_from_store(numbers_of(trials_)), simulations_);
        double done = 0;
        for (const auto& batch : batches_of(jobs, trials_, max_grains_at_once)) {
            const double part = static_cast<double>(batch.size()) / static_cast<double>(jobs.size());
            run(batch, done, done + part);
            done += part;
        }
    }

    void run(const std::vector<Job>& jobs, double from, double to) {
        Scene batch = common_.scene;
        batch.output.positions = batch.output.contacts = true;
        batch.replicas.clear();
        std::vector<Packing> packings;
        for (const Job& job : jobs) {
            const Trial& trial = trials_[job.front()];
            batch.replicas.push_back(trial.model.replica);
            batch.replicas.back().packing.seed = trial.seed;
            packings.push_back(trial.packing);
            apply_jitter(packings.back(), trial.jitter, trial.seed);
            Random random(trial.seed, Stream::diameter_jitter);
            for (double& diameter : packings.back().diameter)
                diameter += trial.diameter_jitter * random.normal();
        }
        for (std::size_t r = 0; r < packings.size(); ++r)
            batch.slots = std::max(batch.slots, slots_of(batch.replicas[r], packings[r]));
        Callbacks callbacks = callbacks_;
        callbacks.on_progress = [&](double part) { callbacks_.on_progress(from + (to - from) * part); };
        callbacks.on_failure = [&](std::size_t j, const Failure& failure) {
            callbacks_.on_failure(jobs[j].front(), failure);
        };
        EarlyEnd early;
        early.is_enough = [&](std::size_t j, const Recording& recording) {
            return has_left_bins(jobs[j], batch.replicas[j], recording);
        };
        measure_and_store(jobs, simulate(device_, batch, packings, callbacks, early));
    }

    /// Whether the plate has left the bins on its last way back: no later scan counts, and a plate that
    /// follows the load is slowest there. Recordings that are kept are whole.
    bool has_left_bins(const Job& job, const Replica& replica, const Recording& recording) const {
        if (!replica.programme.empty()) return false;  // its plate may come back
        const Scan& last = recording.scans.back();
        if (last.phase != Phase::unload || last.cycle + 1 < replica.protocol.cycles) return false;
        const double left = std::ranges::min(common_.grid.displacement) - common_.grid.width;
        return std::ranges::all_of(job, [&](std::size_t t) {
            const double offset = trials_[t].model.instrument.strain_offset;
            return !trials_[t].keep_recording && recording.displacement(last) + std::abs(offset) < left;
        });
    }

    /// Measures and observes on all cores; files are written by one thread, where errors can be reported.
    void measure_and_store(const std::vector<Job>& jobs, const std::vector<Recording>& recordings) {
        std::vector<std::optional<Recording>> kept(trials_.size());
        in_parallel(jobs.size(), [&](std::size_t j) {
            for (const std::size_t t : jobs[j]) measure(t, recordings[j], kept[t]);
        });
        for (const Job& job : jobs)
            for (const std::size_t t : job) {
                if (kept[t]) store_.keep(names_[t], *kept[t]);
                store_.keep(names_[t], Eigen::VectorXd(result_.row(static_cast<Eigen::Index>(t))));
            }
    }

    void measure(std::size_t t, const Recording& truth, std::optional<Recording>& kept) {
        Recording seen = measured(truth, trials_[t].model.instrument, trials_[t].seed);
        if (!truth.failure)
            result_.row(static_cast<Eigen::Index>(t)) =
                observe(seen, common_.grid, common_.material, common_.discard);
        if (trials_[t].keep_recording) kept = std::move(seen);
    }

    Device& device_;
    const TrialSettings& common_;
    const std::vector<Trial>& trials_;
    const ObservationStore& store_;
    const Callbacks& callbacks_;
    std::vector<std::string> simulations_, names_;  ///< by trial
    Eigen::MatrixXd result_;
};

}  // namespace

Eigen::MatrixXd observe_trials(Device& device, const TrialSettings& common, const std::vector<Trial>& trials,
                               const ObservationStore& store, const Callbacks& callbacks) {
    return Work(device, common, trials, store, callbacks).all();
}

std::vector<std::vector<Trial>> parts_of_trials(const TrialSettings& common,
                                                const std::vector<Trial>& trials) {
    std::vector<std::string> simulations;
    for (const Trial& trial : trials) simulations.push_back(simulation_name("", common, trial));
    std::vector<std::vector<Trial>> parts;
    for (const auto& batch :
         batches_of(jobs_of(numbers_of(trials), simulations), trials, max_grains_of_a_part)) {
        parts.emplace_back();
        for (const Job& job : batch)
            for (const std::size_t t : job) parts.back().push_back(trials[t]);
    }
    return parts;
}

bool are_observed(const std::string& device, const TrialSettings& common, const std::vector<Trial>& trials,
                  const ObservationStore& store) {
    return std::ranges::all_of(trials, [&](const Trial& trial) {
        const std::string name =
            observation_name(simulation_name(device, common, trial), common, trial.model.instrument);
        return store.find(name) && (!trial.keep_recording || store.has_recording(name));
    });
}

std::vector<Recording> kept_recordings(const Device& device, const TrialSettings& common,
                                       const std::vector<Trial>& trials, const ObservationStore& store) {
    std::vector<Recording> recordings;
    for (const Trial& trial : trials)
        recordings.push_back(store.recording(observation_name(
            simulation_name(device.description(), common, trial), common, trial.model.instrument)));
    return recordings;
}

ReferenceMaterial reference_material(const Model& model) {
    const auto& grains = model.replica.grains;
    const auto& walls = model.replica.walls;
    return {grains.youngs_modulus, grains.poisson_ratio, walls.youngs_modulus,
            walls.poisson_ratio,   grains.friction,      model.instrument.stated.force_threshold};
}

}  // namespace mcdem::ensemble
