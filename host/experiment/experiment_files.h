// Contents of the files of an experiment before they are written, and their digests.
#pragma once
#include <map>
#include <string>

#include "experiment/experiment.h"

namespace mcdem::inline experiment {

/// Contents by file name.
std::map<std::string, std::string> experiment_files(const Experiment& experiment, Packed packed);

/// Throws InputError with the problems that read_experiment would find if these files, not compressed, were
/// in the folder.
void expect_readable(const std::filesystem::path& folder, const std::map<std::string, std::string>& texts);

/// SHA-256 and name of each file, in the format of `sha256sum -c`.
std::string sums_text(const std::map<std::string, std::string>& files);

/// The file of an experiment with these sums.
inline constexpr const char* sums_file = "SHA256SUMS";

}  // namespace mcdem::experiment
