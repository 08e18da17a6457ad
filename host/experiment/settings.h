// experiment.toml: what the tables do not say.
#pragma once
#include "experiment/experiment.h"
#include "experiment/experiment_problems.h"

namespace mcdem::inline experiment {

/// Reads name, box, materials, uncertainty, measurement and, where given, plate_start (else not-a-number).
void read_settings(const std::filesystem::path& file, Experiment& experiment, ExperimentProblems& problems);

/// The same of a TOML text, or none, and of overrides "grains.youngs_modulus=23300", which count before it.
/// A name that is not stated stays as it is.
void parse_settings(std::string_view text, const std::string& file, const std::vector<std::string>& overrides,
                    Experiment& experiment, ExperimentProblems& problems);

std::string settings_text(const Experiment& experiment);

}  // namespace mcdem::experiment
