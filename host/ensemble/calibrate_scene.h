// Finds the gamma with which a scene, run with model mc_dem, has the reference's top force at its maximum
// compression; or, for a model without gamma, the Young's modulus of the grains.
#pragma once
#include <functional>
#include <optional>

#include "calibrate/calibrate_gamma.h"
#include "cl/device.h"
#include "metrics/estimate.h"
#include "metrics/replicas.h"
#include "scene/scene.h"

namespace mcdem::inline ensemble {

struct CalibrateOptions {
    ContactModel model = ContactModel::mc_dem;  ///< another: E is searched for, over the scene's
    Bracket bracket{0.5, 1.5};
    CalibrationOptions search;
    /// Called after every round of steps of round `round` (from 0), with the part of it that is done.
    std::function<void(int round, double fraction)> on_progress = [](int, double) {};
};

struct SceneCalibration {
    Calibration found;          ///< gamma, or E over the scene's
    double youngs_modulus = 0;  ///< the scene's [Pa]; 0 where gamma was searched for
    Estimate target;            ///< the reference's mean top force [N]
    double displacement = 0;    ///< of the plate, where it was taken [m]
    int replicas = 0;           ///< packings behind each evaluation

    bool of_modulus() const { return youngs_modulus > 0; }
    /// What was searched for, with its unit: as in calibration.json.
    std::string key() const { return of_modulus() ? "youngs_modulus_Pa" : "gamma"; }
    /// Of the numbers in `found`.
    double unit() const { return of_modulus() ? youngs_modulus : 1; }
};

/// The scene gives packings, materials and protocol; what it says of contact.model and contact.gamma is left
/// aside, nothing else may vary. A value counts as running away when half of its replicas or more do; else
/// the mean is over the others. Throws InputError or RunError.
SceneCalibration calibrate_scene(Device& device, const Scene& scene, const Replicas& reference,
                                 const CalibrateOptions& options);

/// The replicas that a calibration runs for each value: one for each packing of the scene.
std::vector<Replica> calibration_replicas(const Scene& scene, ContactModel model = ContactModel::mc_dem);

}  // namespace mcdem::ensemble
