// Reader of experiment.toml.
#pragma once
#include "experiment/experiment.h"
#include "scene/read/problems.h"

namespace mcdem::inline experiment {

/// Reads name, box, materials, uncertainty, measurement and plate_start (NaN if missing).
void read_settings(const std::filesystem::path& file, Experiment& experiment, FileProblems& problems);

/// The same from TOML text (may be empty) and overrides "grains.youngs_modulus=23300", which have precedence.
/// If there is no name, the present one is kept.
void parse_settings(std::string_view text, const std::string& file, const std::vector<std::string>& overrides,
                    Experiment& experiment, FileProblems& problems);

std::string settings_text(const Experiment& experiment);

}  // namespace mcdem::experiment
