// The library of effects that a simulation may neglect, and of uncertain parameters. A new effect is one row
// in effects.cpp (CONTRIBUTING.md).
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiment/instrument.h"
#include "scene/scene.h"

namespace mcdem::inline diagnose {

/// A simulation and the instrument that measures it.
struct Model {
    Replica replica;
    Instrument instrument;
    double mean_diameter = 0;                     ///< of the experiment's grains [m]
    std::optional<double> experiment_speed = {};  ///< of the experiment's plate [m/s]; empty: slow
};

/// A key of the scene and its value in a model.
struct NumericalSetting {
    std::string_view key;
    double* value;
};

/// A way in which an experiment may differ from the model; the amplitude is zero for the unchanged model.
struct Effect {
    std::string_view name;
    std::string_view words;         ///< in texts; empty: the name with blanks
    std::string_view unit;          ///< of the amplitude; empty for dimensionless ones
    std::string_view formula;       ///< meaning of the amplitude
    std::string_view source;        ///< reference for the formula
    double low, high;               ///< range of plausible amplitudes, over the scale
    double first, second;           ///< amplitudes of the paired runs, over the scale
    double (*scale)(const Model&);  ///< natural scale of the amplitude in this model [unit]
    void (*apply)(Model&, double amplitude);
    /// Reason why this model cannot have the effect; empty if it can.
    std::string_view (*hindrance)(const Model&);
    /// For effects of the simulation's own numerics: the settings that are lowered together; the first one is
    /// recommended to the user. Null for effects of the real system or the instrument.
    std::vector<NumericalSetting> (*settings)(Model&) = nullptr;
};

/// All candidates, in the order of the documentation.
std::span<const Effect> effects();
const Effect* find_effect(std::string_view name);
/// Whether it is an effect of the simulation's own numerics.
bool is_numerical(std::string_view name);
/// Whether it depends on the speed of the plate.
bool depends_on_speed(std::string_view name);

/// An uncertain parameter of the model, refitted in every comparison.
struct Nuisance {
    std::string name;
    std::string unit;
    double sigma = 0;  ///< prior [unit]
    void (*apply)(Model&, double shift) = nullptr;
};

/// The model's nuisances. Sigmas are taken from the experiment's [uncertainty] if given there.
std::vector<Nuisance> nuisances(const Model& model, const Experiment& experiment);

}  // namespace mcdem::diagnose
