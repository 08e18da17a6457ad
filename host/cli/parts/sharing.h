// Command-line options for work in parts (ensemble/parts/parted_work.h, host/ensemble/README.md).
#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ensemble/parts/parted_work.h"

namespace mcdem::inline cli {

/// The parts k with k % of = number - 1.
struct WorkShare {
    std::size_t number = 1, of = 1;
};

struct SharingOptions {
    const CLI::App* command = nullptr;  ///< to which they were added
    std::optional<WorkShare> share;
    std::size_t workers = 1;
    bool missing = false, merge = false;
};

/// Adds --part, --missing, --merge and --workers, and --device with its meaning here.
void add_sharing_options(CLI::App& command, SharingOptions& options, std::string& device);

/// The words of the command line ("run", scene, ..) without `--resume` and without options that determine
/// where and how it runs.
std::vector<std::string> words_of(const SharingOptions& options);

/// Whether the command line requests work in parts.
bool is_shared(const SharingOptions& options);

struct SharedWork {
    std::filesystem::path out;  ///< the shared folder
    /// Starts or continues the work; `workers`: number of expected workers. Throws InputError if the content
    /// of the folder, or another program that uses it, is incompatible.
    std::function<std::unique_ptr<PartedWork>(std::size_t workers)> begin;
    /// Called with the device before it is used.
    std::function<void(Device&)> check = [](Device&) {};
    /// Called after the merge, when the lock on the parts is released: reports to the user, returns the exit
    /// code.
    std::function<int()> report;
};

/// Computes a share, lists what is missing, or merges, as the options say; otherwise computes all that is
/// missing and merges. Returns the exit code.
int share(const SharedWork& work, const SharingOptions& options, const std::string& device);

}  // namespace mcdem::cli
