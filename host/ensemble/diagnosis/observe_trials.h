// Many small simulations, each observed through an instrument, for signature libraries, noise floors and the
// confirmation of effects.
#pragma once
#include <string>
#include <vector>

#include "diagnose/effects.h"
#include "diagnose/observe/observation.h"
#include "ensemble/diagnosis/observation_store.h"
#include "ensemble/make_packings.h"

namespace mcdem::inline ensemble {

/// One simulation and its observation.
struct Trial {
    Model model;
    Packing packing;             ///< initial packing, as measured
    double jitter = 0;           ///< standard deviation of the noise on every initial coordinate [m]
    double diameter_jitter = 0;  ///< standard deviation of the noise on every diameter [m]
    std::uint64_t seed =
        0;  ///< for both jitters, random properties of the replica, and the noise of the measurement
    bool keep_recording = false;  ///< also store the complete recording, as measured
};

/// Common settings of all trials.
struct TrialSettings {
    Scene scene;  ///< precision and slots; its replicas are ignored
    Grid grid;
    ReferenceMaterial material;
    int discard = 0;      ///< number of first cycles that are ignored
    std::string program;  ///< version and commit
};

/// Row: trial, column: bin; NaN if a simulation failed. Trials that differ only in the instrument share a
/// simulation, and results in the store are reused, without a call of on_failure. Results are stored as they
/// are computed. Throws
/// Interrupted if stop_wanted returns true.
Eigen::MatrixXd observe_trials(Device& device, const TrialSettings& common, const std::vector<Trial>& trials,
                               const ObservationStore& store, const Callbacks& callbacks);

/// Divides the trials into parts that can be simulated separately; the division does not depend on the
/// device. Trials that share a simulation are in the same part.
std::vector<std::vector<Trial>> parts_of_trials(const TrialSettings& common,
                                                const std::vector<Trial>& trials);

/// Whether the store contains the observations of all these trials for this device.
bool are_observed(const std::string& device, const TrialSettings& common, const std::vector<Trial>& trials,
                  const ObservationStore& store);

/// Recordings of trials that were observed with keep_recording.
std::vector<Recording> kept_recordings(const Device& device, const TrialSettings& common,
                                       const std::vector<Trial>& trials, const ObservationStore& store);

/// Material for the evaluation of observations: that of the model.
ReferenceMaterial reference_material(const Model& model);

}  // namespace mcdem::ensemble
