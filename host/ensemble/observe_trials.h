// Many small simulations, each looked at through an instrument: what a signature library, a noise floor and
// the confirmation of a cause are made of.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "cl/device.h"
#include "diagnose/infer/effects.h"
#include "diagnose/observe/observation.h"
#include "ensemble/observation_store.h"

namespace mcdem::inline ensemble {

/// One simulation and one look at it.
struct Trial {
    Model model;
    Packing packing;             ///< where it starts, as measured
    double jitter = 0;           ///< sd of a random displacement of every coordinate of it [m]
    double diameter_jitter = 0;  ///< sd of a random change of every diameter [m]
    std::uint64_t seed =
        0;  ///< of both jitters, of what is random in the replica, and of the measurement's noise
    bool keep_recording = false;  ///< the whole recording too, as measured
};

/// What all trials of one question share.
struct Question {
    Scene scene;  ///< precision and slots; its replicas are not looked at
    Grid grid;
    ReferenceMaterial material;
    int discard = 0;      ///< first cycles left out
    std::string program;  ///< version and commit
};

struct TrialOptions {
    std::function<void(double fraction)> on_progress = [](double) {};
    std::function<bool()> stop_wanted = [] { return false; };
};

/// Row: trial, column: cell; not-a-number where a simulation failed. Trials that differ in the instrument
/// only share a simulation, and what the store has is not simulated at all. All are kept as they come. Throws
/// Interrupted when stop_wanted says so.
Eigen::MatrixXd observe_trials(Device& device, const Question& question, const std::vector<Trial>& trials,
                               const ObservationStore& store, const TrialOptions& options);

/// The trials in parts that a process simulates alone, the same ones on every device. Trials that share a
/// simulation lie in one part.
std::vector<std::vector<Trial>> parts_of_trials(const Question& question, const std::vector<Trial>& trials);

/// Whether the store has the observations of all these trials by a device of this description.
bool are_observed(const std::string& device, const Question& question, const std::vector<Trial>& trials,
                  const ObservationStore& store);

/// Recordings of trials that were observed with keep_recording.
std::vector<Recording> kept_recordings(const Device& device, const Question& question,
                                       const std::vector<Trial>& trials, const ObservationStore& store);

struct Interrupted : std::runtime_error {
    Interrupted() : std::runtime_error("interrupted; the same command goes on where it stopped") {}
};

/// The material that observations are evaluated with: the model's.
ReferenceMaterial reference_material(const Model& model);

}  // namespace mcdem::ensemble
