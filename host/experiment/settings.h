// experiment.toml: what the tables do not say.
#pragma once
#include "experiment/experiment.h"
#include "experiment/experiment_problems.h"

namespace mcdem {

/// Reads name, box, materials, uncertainty, measurement and, where given, plate_start (else not-a-number).
void read_settings(const std::filesystem::path& file, Experiment& experiment, ExperimentProblems& problems);

std::string settings_text(const Experiment& experiment);

}  // namespace mcdem
