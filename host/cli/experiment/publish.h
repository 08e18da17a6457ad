// Moves a finished experiment to the folder of --out: nothing of it is there, or all.
#pragma once
#include <filesystem>

namespace mcdem::inline cli {

/// Where the work folder of an experiment for `out` is made: on the same file system.
std::filesystem::path place_of_work(const std::filesystem::path& out);

/// Throws InputError if the folder contains another experiment or a run. First removes what a killed
/// `publish` has left there, which is known by its SHA-256.
void expect_free(const std::filesystem::path& out);

/// Moves all files of the folder `work` to the folder `out`; where both have a mapping.toml, the one there
/// stays. A new folder appears by one rename. In a folder that exists, experiment.toml comes last, because it
/// makes the folder an experiment. After any failure nothing of it is in `out`, unless the message says so.
/// Throws RunError, and InputError as expect_free and open_output_folder do.
void publish(const std::filesystem::path& work, const std::filesystem::path& out);

}  // namespace mcdem::cli
