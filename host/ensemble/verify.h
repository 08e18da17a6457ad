// Verification of the files of commands: runs, experiments, diagnoses and their libraries.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace mcdem::inline ensemble {

/// Result for one file.
struct Verified {
    std::filesystem::path file;
    bool is_good = false;
    std::string note;  ///< reason of a failure, or what could not be checked
};

/// Checks all files of a folder, or one file, against their digests. Throws InputError if there are no files
/// of this program, RunError if the system refuses to read.
std::vector<Verified> verify(const std::filesystem::path& file_or_folder);

}  // namespace mcdem::ensemble
