// An artificial run with all kinds of data, the same for the same arguments, and helpers for files.
#pragma once
#include <string>

#include "core/recording.h"
#include "core/test_folder.h"

namespace mcdem::test {

struct Size {
    int replicas = 2;
    int grains = 27;
    int scans = 6;  ///< half of them loading
    std::string precision = "double";
};

/// Grains on a lattice in a box, compressed by a plate, with plausible contacts and forces.
Run synthetic_run(const Size& size = {});

/// Scans first .. last - 1 of every recording, as a run.
Run part_of(const Run& run, std::size_t first, std::size_t last);

/// Fails the test with the first difference unless both runs are equal. Positions and contacts agree within
/// the relative `tolerance` (0: bit for bit); NaN equals NaN.
void expect_same(const Run& expected, const Run& found, double tolerance = 0);

/// Output (both streams) and exit code of a shell command.
struct Finished {
    int exit_code;
    std::string output;
};
Finished run_command(const std::string& command);

}  // namespace mcdem::test
