// Results of a run as HDF5, with a layout similar to H5MD (README.md in this folder describes every table).
#pragma once
#include <filesystem>
#include <memory>
#include <optional>

#include "core/packing.h"
#include "core/recording.h"
#include "core/stop.h"

namespace mcdem::inline io {

/// Data to read: scalars of the scans are always read; positions and contacts are most of the data.
enum class ReadWhat { observables, positions, contacts, everything };

/// Writes the complete run, or, after an error, nothing.
void write_run(const std::filesystem::path& file, const Run& run);

/// Reads a result file, or a result folder: its run.h5, otherwise the segments of an unfinished run. Throws
/// Interrupted if `stop_wanted` becomes true meanwhile.
Run read_run(const std::filesystem::path& file_or_folder, ReadWhat what = ReadWhat::everything,
             const StopWanted& stop_wanted = never_stop);

/// Reads a run scan by scan, for runs larger than memory.
class RunReader {
public:
    explicit RunReader(const std::filesystem::path& file_or_folder);
    ~RunReader();
    /// The run without positions and contacts.
    const Run& run() const { return run_; }
    /// One scan with all recorded data.
    Scan read_scan(std::size_t replica, std::size_t scan);

private:
    Run run_;
    std::unique_ptr<class ResultFiles> files_;
    std::vector<std::vector<std::size_t>> first_scan_;  ///< by file and replica
};

}  // namespace mcdem::io
