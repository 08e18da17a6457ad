// A made-up run with everything in it, the same for the same numbers, and what tests do with files.
#pragma once
#include <filesystem>
#include <string>

#include "core/recording.h"

namespace mcdem::test {

struct Size {
    int replicas = 2;
    int grains = 27;
    int scans = 6;  ///< half of them loading
    std::string precision = "double";
};

/// Grains on a lattice in a box, pressed by a plate, with plausible contacts and forces.
Run synthetic_run(const Size& size = {});

/// Scans first .. last - 1 of every recording, as a run of its own.
Run part_of(const Run& run, std::size_t first, std::size_t last);

/// Fails the test, naming the first difference, unless both runs are the same. Positions and contacts agree
/// to `tolerance` relative (0: the same bits); not-a-numbers are equal.
void expect_same(const Run& expected, const Run& found, double tolerance = 0);

/// A folder that goes when the test does.
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

private:
    std::filesystem::path path_;
};

std::string read_bytes(const std::filesystem::path& file);
void write_bytes(const std::filesystem::path& file, const std::string& bytes);

/// What a shell command printed (both streams) and its exit code.
struct Finished {
    int exit_code;
    std::string output;
};
Finished run_command(const std::string& command);

}  // namespace mcdem::test
