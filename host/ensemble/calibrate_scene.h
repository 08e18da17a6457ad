// Finds the gamma with which a scene with model mc_dem has the reference's top force at its maximum
// compression. For a model without gamma it finds the Young's modulus of the grains.
#pragma once
#include <functional>
#include <string>

#include "calibrate/calibrate_gamma.h"
#include "cl/device.h"
#include "metrics/estimate.h"
#include "metrics/replicas.h"
#include "scene/scene.h"

namespace mcdem::inline ensemble {

struct CalibrateOptions {
    ContactModel model = ContactModel::mc_dem;  ///< for other models E over that of the scene is searched for
    Bracket bracket{0.5, 1.5};
    CalibrationOptions search;
    /// Called after every interval of round `round` (from 0), with the completed fraction of the round.
    std::function<void(int round, double fraction)> on_progress = [](int, double) {};
    std::function<void(const std::string& note)> on_note = [](const std::string&) {};
};

struct SceneCalibration {
    Calibration found;          ///< gamma, or E over that of the scene
    double youngs_modulus = 0;  ///< of the scene [Pa]; 0 if gamma was searched for
    Estimate target;            ///< mean top force of the reference [N]
    Estimate simulated;         ///< of the scene's packings, for the last value that was evaluated [N]
    double displacement = 0;    ///< of the plate at the target [m]
    int replicas = 0;           ///< number of packings in each evaluation

    /// Standard error of found.gamma: of the fit, of the reference and of the scene's packings. A single
    /// packing has no standard error; its scatter is left out.
    double standard_error() const;
    bool knows_scatter() const;

    bool of_modulus() const { return youngs_modulus > 0; }
    /// Name of the parameter with its unit, as in calibration.json.
    std::string key() const { return of_modulus() ? "youngs_modulus_Pa" : "gamma"; }
    /// Unit of the numbers in `found`.
    double unit() const { return of_modulus() ? youngs_modulus : 1; }
};

/// The scene provides packings, materials and protocol. Its contact.model and contact.gamma are ignored;
/// nothing else may vary. A value counts as running away if at least half of its replicas do; otherwise the
/// mean is over the others. Throws InputError or RunError.
SceneCalibration calibrate_scene(Device& device, const Scene& scene, const Replicas& reference,
                                 const CalibrateOptions& options);

/// The text of calibration.json. `reference`: label of its setting.
std::string calibration_json(const SceneCalibration& result, ContactModel model, const Scene& scene,
                             const std::string& reference, const std::string& program);

/// The contact model to calibrate. Throws InputError, which names the `option` and all models.
ContactModel calibrated_model(const std::string& model, const std::string& option);

/// The replicas of a calibration for each value: one for each packing of the scene.
std::vector<Replica> calibration_replicas(const Scene& scene, ContactModel model = ContactModel::mc_dem);

}  // namespace mcdem::ensemble
