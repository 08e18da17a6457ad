// Results of a run as HDF5, laid out like H5MD (README.md beside this file describes every table).
#pragma once
#include <filesystem>
#include <memory>

#include "core/recording.h"

namespace mcdem::inline io {

/// How much of a run to read: the scans' scalars are always read, positions and contacts are the bulk.
enum class ReadWhat { observables, positions, contacts, everything };

/// Writes the run whole or, on any error, not at all.
void write_run(const std::filesystem::path& file, const Run& run);

/// Reads a result file, or a result folder: its run.h5, else the segments of a run in progress.
Run read_run(const std::filesystem::path& file_or_folder, ReadWhat what = ReadWhat::everything);

/// Reads a run scan by scan, for runs larger than memory.
class RunReader {
public:
    explicit RunReader(const std::filesystem::path& file_or_folder);
    ~RunReader();
    /// The run without positions and contacts.
    const Run& run() const { return run_; }
    /// One scan with everything recorded.
    Scan read_scan(std::size_t replica, std::size_t scan);

private:
    class Files;
    Run run_;
    std::unique_ptr<Files> files_;
    std::vector<std::vector<std::size_t>> first_scan_;  ///< by file and replica
};

}  // namespace mcdem::io
