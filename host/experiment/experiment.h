// Measured compressions: a folder with experiment.toml, plate.csv and, where measured, grains.csv and
// contacts.csv (README.md beside this file), read into the same form as simulations.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "core/recording.h"

namespace mcdem::inline experiment {

/// How well it was measured; a simulation seen through the same instrument is comparable.
struct Measurement {
    double position_error = 0;   ///< sigma of every coordinate of a centre [m]
    double diameter_error = 0;   ///< sigma [m]
    double force_error = 0;      ///< relative sigma of a contact force
    double force_threshold = 0;  ///< contact forces below it are not seen [N]
    bool operator==(const Measurement&) const = default;
};

struct Experiment {
    std::string name;
    /// Positions, contacts, top force by scan. Z, <f> and <b> come from the contacts above the force
    /// threshold; what was not measured is not-a-number or empty.
    Recording recording;
    std::map<std::string, double> materials;    ///< scene keys that were measured: "grains.youngs_modulus"
    std::map<std::string, double> uncertainty;  ///< one sigma of some of them, by the same key
    Measurement measurement;
    std::optional<double> plate_speed = {};  ///< [m/s]; nothing: slow
};

/// The scene keys that `materials` and `uncertainty` may hold.
const std::vector<std::string>& material_keys();

/// Bytes of one table, unpacked, that are read [1 GiB: some 12 million contacts]. Memory needed is about the
/// tables' size.
inline constexpr std::uintmax_t largest_table = std::uintmax_t{1} << 30;

/// Throws InputError with every problem found (the first 20), each as file:line and what to do.
Experiment read_experiment(const std::filesystem::path& folder, std::uintmax_t largest = largest_table);

enum class Packed { plain, gzip };

/// Writes the folder, so that read_experiment gives back what it holds, numbers to the last digit. Averages
/// are left to the reader, and what an instrument would not have seen to `measured` (instrument.h).
void write_experiment(const std::filesystem::path& folder, const Experiment& experiment,
                      Packed packed = Packed::plain);

}  // namespace mcdem::experiment
