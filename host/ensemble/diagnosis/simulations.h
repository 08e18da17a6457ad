// The simulations that a diagnosis asks for, as observations: what Python gets (host/python/mcdem/diagnosis).
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ensemble/diagnosis/diagnosis_plan.h"
#include "ensemble/diagnosis/other_protocols.h"
#include "ensemble/diagnosis/plate_motion.h"

namespace mcdem::inline ensemble {

/// Amplitudes by name, of effects and of nuisances: what a fitted simulation has that the scene has not.
using Amplitudes = std::vector<std::pair<std::string, double>>;

/// Observations are matrices: a row for each simulation, NaN if it failed; a column for each bin of the
/// grid. Simulations are kept in a folder and never repeated.
class Simulations {
public:
    /// `device`: a choice (cl/device.h); it is opened when something must be simulated, and shared by all
    /// simulations of the same choice.
    Simulations(DiagnosisPlan plan, const std::filesystem::path& folder, std::string device);

    const DiagnosisPlan& plan() const { return plan_; }
    /// Description of the device.
    std::string device() { return opened().description(); }
    std::string device_name() { return opened().info().name; }
    /// What a library depends on (library_origin.h).
    std::map<std::string, std::string> origin() const;
    /// Compares at the displacements of a library from now on.
    void compare_at(Grid grid) { plan_.common.grid = std::move(grid); }
    /// Row: experiment.
    Eigen::MatrixXd observed() const;

    /// The trials of a library: the baseline, packing after packing; then for each probe and each of its two
    /// amplitudes the paired rows of the baseline again.
    Eigen::MatrixXd library(const Callbacks& callbacks);

    Eigen::MatrixXd baseline(const Callbacks& callbacks);
    /// With half the error of positions.
    Eigen::MatrixXd finer_baseline(const Callbacks& callbacks);
    /// `runs` of every packing with each of the fits, with the protocol of other_protocols() if given.
    Eigen::MatrixXd fitted(const std::vector<Amplitudes>& fits, int runs, std::optional<std::size_t> protocol,
                           const Callbacks& callbacks);
    /// Why simulations failed until now, by the probe (library) or "" (unchanged scene).
    const std::map<std::string, std::string>& causes_of_failure() const { return causes_; }

    /// Stores recordings of the first `runs` of the baseline, or of a fit.
    void record(const Amplitudes& fit, int runs, const Callbacks& callbacks);
    /// Those that `record` has stored.
    std::vector<Recording> recordings(const Amplitudes& fit, int runs);

    /// The setting that a numerical effect lowers, of several together the one to recommend; its values are
    /// the present one twice.
    SettingChange setting(const std::string& effect);
    /// Multiplies it, and those that go with it.
    void refine(const std::string& effect, double factor);
    /// The plate's motion that the experiment states and the scene has not (plate_motion.h).
    std::vector<SettingChange> neglected_motion(double max_slowdown) const;
    void follow_motion(double max_slowdown);
    /// What other protocols would tell effects apart, by runs of `fitted`.
    std::vector<std::string> other_protocols(bool slower);
    /// "contact.gamma = 1.16" for every key of the scene that these amplitudes change.
    std::vector<std::string> changed_keys(const Amplitudes& amplitudes) const;

    /// Parts of the library's simulations, for several processes; those of `device` that are missing.
    std::size_t count_parts();
    std::vector<std::size_t> missing_parts(const std::string& device);
    void compute_part(std::size_t part, const Callbacks& callbacks);

private:
    using Trials = std::vector<Trial>;
    Device& opened();
    const Model& model() const { return plan_.library.packings.front().model; }
    void apply(Model& model, const Amplitudes& amplitudes) const;
    Trials trials_of(const Amplitudes& fit, int runs) const;
    Trials recorded_trials(const Amplitudes& fit, int runs) const;
    const std::vector<Trials>& parts();
    Eigen::MatrixXd observe_probes(const Trials& trials, Callbacks callbacks);

    DiagnosisPlan plan_;
    ObservationStore store_;
    std::string choice_;
    std::shared_ptr<Device> device_;
    std::optional<std::vector<Trials>> parts_;
    std::vector<OtherProtocol> protocols_;
    std::map<std::string, std::string> causes_;
};

}  // namespace mcdem::ensemble
