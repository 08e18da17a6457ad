#include "ensemble/diagnosis/simulations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <mutex>

#include "core/errors.h"
#include "ensemble/diagnosis/library_origin.h"
#include "scene/read/keys.h"

namespace mcdem::inline ensemble {
namespace {

/// Number of the first trials of a library with complete recordings, for the metrics of the paper.
constexpr std::size_t trials_recorded = 4;

void keep_recordings(std::vector<Trial>& trials) {
    for (std::size_t t = 0; t < std::min(trials.size(), trials_recorded); ++t)
        trials[t].keep_recording = true;
}

}  // namespace

Simulations::Simulations(DiagnosisPlan plan, const std::filesystem::path& folder, std::string device)
    : plan_(std::move(plan)), store_(folder), choice_(std::move(device)) {}

Device& Simulations::opened() {
    static std::mutex mutex;
    static std::map<std::string, std::weak_ptr<Device>> devices;  // by choice
    if (device_) return *device_;
    const std::lock_guard lock(mutex);
    auto& open = devices[choice_];
    if (!(device_ = open.lock())) open = device_ = std::make_shared<Device>(choice_);
    return *device_;
}

std::map<std::string, std::string> Simulations::origin() const {
    return library_origin(plan_.common, model(), plan_.library.packings.front().packing.size());
}

Eigen::MatrixXd Simulations::observed() const {
    const TrialSettings& common = plan_.common;
    Eigen::MatrixXd rows(static_cast<Eigen::Index>(plan_.experiments.size()),
                         static_cast<Eigen::Index>(bins_of(common.grid).size()));
    for (std::size_t p = 0; p < plan_.experiments.size(); ++p)
        rows.row(static_cast<Eigen::Index>(p)) =
            observe(plan_.experiments[p].recording, common.grid, common.material, common.discard);
    return rows;
}

Eigen::MatrixXd Simulations::observe_probes(const Trials& trials, Callbacks callbacks) {
    callbacks.on_failure = [this](std::size_t trial, const Failure& failure) {
        causes_.emplace(probe_of_trial(plan_.library, trial), failure.cause);
    };
    return observe_trials(opened(), plan_.common, trials, store_, callbacks);
}

Eigen::MatrixXd Simulations::library(const Callbacks& callbacks) {
    return observe_probes(library_trials(plan_.library), callbacks);
}

Eigen::MatrixXd Simulations::baseline(const Callbacks& callbacks) {
    return observe_probes(baseline_trials(plan_.library), callbacks);
}

Eigen::MatrixXd Simulations::finer_baseline(const Callbacks& callbacks) {
    return observe_trials(opened(), plan_.common, finer_baseline_trials(plan_.library), store_, callbacks);
}

void Simulations::apply(Model& model, const Amplitudes& amplitudes) const {
    for (const auto& [name, amplitude] : amplitudes) {
        if (const Effect* effect = find_effect(name)) {
            effect->apply(model, amplitude);
            continue;
        }
        const auto nuisance = std::ranges::find(plan_.library.nuisances, name, &Nuisance::name);
        if (nuisance == plan_.library.nuisances.end())
            throw InputError(name + ": is neither an effect nor an uncertain parameter");
        nuisance->apply(model, amplitude);
    }
}

Simulations::Trials Simulations::trials_of(const Amplitudes& fit, int runs) const {
    LibraryPlan plan = plan_.library;
    plan.replicates = runs;
    for (LibraryPacking& packing : plan.packings) apply(packing.model, fit);
    return baseline_trials(plan);
}

Eigen::MatrixXd Simulations::fitted(const std::vector<Amplitudes>& fits, int runs,
                                    std::optional<std::size_t> protocol, const Callbacks& callbacks) {
    Trials all;
    for (const Amplitudes& fit : fits)
        for (Trial& trial : trials_of(fit, runs)) {
            if (protocol) protocols_.at(*protocol).change(trial.model.replica);
            all.push_back(std::move(trial));
        }
    return observe_trials(opened(), protocol ? protocols_.at(*protocol).common : plan_.common, all, store_,
                          callbacks);
}

Simulations::Trials Simulations::recorded_trials(const Amplitudes& fit, int runs) const {
    Trials trials = trials_of(fit, std::max(1, runs));
    trials.resize(std::min(static_cast<std::size_t>(std::max(0, runs)), trials_recorded));
    keep_recordings(trials);
    return trials;
}

void Simulations::record(const Amplitudes& fit, int runs, const Callbacks& callbacks) {
    observe_trials(opened(), plan_.common, recorded_trials(fit, runs), store_, callbacks);
}

std::vector<Recording> Simulations::recordings(const Amplitudes& fit, int runs) {
    return kept_recordings(opened(), plan_.common, recorded_trials(fit, runs), store_);
}

SettingChange Simulations::setting(const std::string& effect) {
    const NumericalSetting setting =
        find_effect(effect)->settings(plan_.library.packings.front().model).front();
    return {std::string(setting.key), std::string(find_key(setting.key)->unit), *setting.value,
            *setting.value};
}

void Simulations::refine(const std::string& effect, double factor) {
    for (LibraryPacking& packing : plan_.library.packings)
        for (const NumericalSetting& setting : find_effect(effect)->settings(packing.model))
            *setting.value *= factor;
}

std::vector<SettingChange> Simulations::neglected_motion(double max_slowdown) const {
    const auto motion = mcdem::neglected_motion(model().replica, plan_.experiments.front(), max_slowdown);
    return motion ? changes(model().replica, *motion) : std::vector<SettingChange>{};
}

void Simulations::follow_motion(double max_slowdown) {
    const auto motion = mcdem::neglected_motion(model().replica, plan_.experiments.front(), max_slowdown);
    if (!motion) return;
    for (LibraryPacking& packing : plan_.library.packings) mcdem::apply(packing.model.replica, *motion);
}

std::vector<std::string> Simulations::other_protocols(bool slower) {
    protocols_ = mcdem::other_protocols(plan_.common, model().replica, slower);
    std::vector<std::string> all;
    for (const OtherProtocol& protocol : protocols_) all.push_back(protocol.what);
    return all;
}

std::vector<std::string> Simulations::changed_keys(const Amplitudes& amplitudes) const {
    Model changed = model();
    apply(changed, amplitudes);
    Settings a, b;
    a.replica = model().replica;
    b.replica = changed.replica;
    std::vector<std::string> list;
    for (const Key& key : keys()) {
        if (key.scope != Scope::replica || value_text(key, a) == value_text(key, b)) continue;
        const std::string text = value_text(key, b);
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        list.push_back(fmt::format("{} = {}", key.name, *end ? text : fmt::format("{:.3g}", value)));
    }
    return list;
}

const std::vector<Simulations::Trials>& Simulations::parts() {
    if (!parts_) {
        Trials trials = library_trials(plan_.library);
        if (plan_.with_recordings) keep_recordings(trials);
        parts_ = parts_of_trials(plan_.common, trials);
    }
    return *parts_;
}

std::size_t Simulations::count_parts() { return parts().size(); }

std::vector<std::size_t> Simulations::missing_parts(const std::string& device) {
    std::vector<std::size_t> numbers;
    for (std::size_t k = 0; k < parts().size(); ++k)
        if (device.empty() || !are_observed(device, plan_.common, parts()[k], store_)) numbers.push_back(k);
    return numbers;
}

void Simulations::compute_part(std::size_t part, const Callbacks& callbacks) {
    observe_trials(opened(), plan_.common, parts().at(part), store_, callbacks);
}

}  // namespace mcdem::ensemble
