// Measured compressions: a folder with experiment.toml, plate.csv and optionally grains.csv and contacts.csv
// (README.md in this folder), read into the same form as simulations.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/recording.h"

namespace mcdem::inline experiment {

/// Accuracy of the measurement; simulations are measured with the same instrument before they are compared.
struct Measurement {
    double position_error = 0;   ///< sigma of every coordinate of a centre [m]
    double diameter_error = 0;   ///< sigma [m]
    double force_error = 0;      ///< relative sigma of a contact force
    double force_threshold = 0;  ///< weaker contacts are not detected [N]
    bool operator==(const Measurement&) const = default;
};

struct Experiment {
    std::string name;
    /// Positions, contacts and top force of each scan. Z, <f> and <b> are computed from the contacts above
    /// the force threshold; unmeasured values are NaN or empty.
    Recording recording;
    std::map<std::string, double> materials;    ///< scene keys that were measured: "grains.youngs_modulus"
    std::map<std::string, double> uncertainty;  ///< one sigma of some of them, by key
    Measurement measurement;
    std::optional<double> plate_speed = {};  ///< [m/s]; empty: slow
    double plate_pause = 0;  ///< the plate stands for this time at each scan [s]; 0: it does not stop
    double plate_hold = 0;   ///< .. at the lowest position [s]
};

/// The scene keys that `materials` and `uncertainty` may contain.
const std::vector<std::string>& material_keys();

/// Maximum uncompressed size of one table [bytes]: 1 GiB, about 12 million contacts. Reading needs about
/// twice as much memory as the tables have bytes.
inline constexpr std::uintmax_t largest_table = std::uintmax_t{1} << 30;

/// Throws InputError with all problems (at most 20), each as file:line and a remedy.
Experiment read_experiment(const std::filesystem::path& folder, std::uintmax_t largest = largest_table);

/// Packings of one experiment; several are named by their folders. Throws InputError, which names the
/// `option`, if there is none or one is given twice.
std::vector<Experiment> read_experiments(const std::vector<std::filesystem::path>& folders,
                                         const std::string& option);

enum class Packed { plain, gzip };

/// Writes the folder so that read_experiment returns the same content, with exact numbers. Averages are not
/// written; `measured` (instrument.h) must remove what an instrument would not see.
void write_experiment(const std::filesystem::path& folder, const Experiment& experiment,
                      Packed packed = Packed::plain);

/// Contents of these files by name.
std::map<std::string, std::string> experiment_files(const Experiment& experiment, Packed packed);

/// SHA-256 and name of each file, in the format of `sha256sum -c`.
std::string sums_text(const std::map<std::string, std::string>& files);

/// The file of an experiment with these sums.
inline constexpr const char* sums_file = "SHA256SUMS";

}  // namespace mcdem::experiment
