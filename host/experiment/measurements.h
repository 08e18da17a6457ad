// Readers of the tables of an experiment folder.
#pragma once
#include <optional>

#include "experiment/experiment.h"
#include "scene/packing/table.h"

namespace mcdem::inline experiment {

/// A scan with all values NaN, measured at rest.
Scan unknown_scan();
// `youngs_modulus` of the grains [Pa], infinite if unknown: limits the plausible forces.

/// plate.csv: one scan per row. For a programme (in the recording's parameters) the rows must be its scans.
void read_plate(Table& table, double youngs_modulus, Recording& recording);
/// grains.csv: diameters from frame 0, positions of the listed frames.
void read_grains(Table& table, Recording& recording);
/// contacts.csv: contacts of the listed frames.
void read_contacts(Table& table, double youngs_modulus, Recording& recording);
/// The frame of a row of these two: one of plate.csv, not below the `previous` one; another is a problem.
std::optional<long> read_frame(Table& table, const Recording& recording, long previous);
/// The largest force on the plate in any scan, at least 0 [N].
double highest_top_force(const Recording& recording);
/// Computes wall forces except the plate's, Z, <f> and <b> of the scans with contacts.
void average_contacts(Recording& recording, double force_threshold);

inline const std::vector<std::string> plate_columns{"frame", "cycle", "phase", "plate_z_m", "top_force_N"};
inline const std::vector<std::string> plate_columns_of_programmes{"set_force_N", "time_s"};  ///< additional
inline const std::vector<std::string> grain_columns{"frame", "grain", "x_m", "y_m", "z_m", "diameter_m"};
inline const std::vector<std::string> contact_columns{"frame", "grain", "partner", "x_m", "y_m",
                                                      "z_m",   "fx_N",  "fy_N",    "fz_N"};

/// Prescribed force at each row of plate.csv [N]; empty if the programme does not prescribe one.
std::vector<std::optional<double>> set_forces(const Recording& recording);

}  // namespace mcdem::experiment
