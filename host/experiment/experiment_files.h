// The files of an experiment before they are written, and the digests that they are checked by later.
#pragma once
#include <map>
#include <string>

#include "experiment/experiment.h"

namespace mcdem::inline experiment {

/// Bytes by file name.
std::map<std::string, std::string> experiment_files(const Experiment& experiment, Packed packed);

/// SHA-256 and name of each, as `sha256sum -c` reads them.
std::string sums_text(const std::map<std::string, std::string>& files);

/// The file of an experiment that holds them.
inline constexpr const char* sums_file = "SHA256SUMS";

}  // namespace mcdem::experiment
