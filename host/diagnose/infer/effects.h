// The library of effects that a simulation may leave out, and of the parameters that it may have slightly
// wrong. A new effect is one row in effects.cpp (CONTRIBUTING.md).
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiment/instrument.h"
#include "scene/scene.h"

namespace mcdem::inline diagnose {

/// A simulation and the instrument that looks at it.
struct Model {
    Replica replica;
    Instrument instrument;
    double mean_diameter = 0;                     ///< of the experiment's grains [m]
    std::optional<double> experiment_speed = {};  ///< of the experiment's plate [m/s]; nothing: slow
};

/// A key of the scene and its value in a model.
struct NumericalSetting {
    std::string_view key;
    double* value;
};

/// One way in which reality may differ from the model, with an amplitude that is zero for the model as it is.
struct Effect {
    std::string_view name;
    std::string_view unit;          ///< of the amplitude, empty for pure numbers
    std::string_view formula;       ///< what the amplitude does
    std::string_view source;        ///< where the formula comes from
    double low, high;               ///< plausible amplitudes, over the scale
    double first, second;           ///< of the paired runs, over the scale
    double (*scale)(const Model&);  ///< natural size of the amplitude in this model [unit]
    void (*apply)(Model&, double amplitude);
    /// Why this model cannot have it; empty where it can.
    std::string_view (*hindrance)(const Model&);
    /// Of the simulation's own numerics: the settings that are lowered together; the first one is advised.
    /// Nothing for what the world or the instrument does.
    std::vector<NumericalSetting> (*settings)(Model&) = nullptr;
};

/// All candidates, in the order of the documentation.
std::span<const Effect> effects();
const Effect* find_effect(std::string_view name);
/// Whether it is the simulation's own numerics: not the world that it leaves out, but how it computes.
bool is_numerical(std::string_view name);

/// A parameter of the model that is known only roughly: refitted in every comparison.
struct Nuisance {
    std::string name;
    std::string unit;
    double sigma = 0;  ///< prior [unit]
    void (*apply)(Model&, double shift) = nullptr;
};

/// The model's nuisances. Sigmas come from the experiment's [uncertainty] where it has them.
std::vector<Nuisance> nuisances(const Model& model, const Experiment& experiment);

}  // namespace mcdem::diagnose
