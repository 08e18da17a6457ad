// Whether what a command left behind is as it was written: runs, experiments, diagnoses and their libraries.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace mcdem::inline ensemble {

/// One file that was looked at.
struct Verified {
    std::filesystem::path file;
    bool is_good = false;
    std::string note;  ///< why not; or what could not be checked
};

/// Reads everything of a folder, or one file, against its digests. Throws InputError where there is nothing
/// that this program writes, RunError where the system refuses to read.
std::vector<Verified> verify(const std::filesystem::path& file_or_folder);

}  // namespace mcdem::ensemble
