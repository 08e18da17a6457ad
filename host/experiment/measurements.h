// Readers of the tables of an experiment folder.
#pragma once
#include "experiment/experiment.h"
#include "experiment/table.h"

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
/// Computes wall forces except the plate's, Z, <f> and <b> of the scans with contacts.
void average_contacts(Recording& recording, double force_threshold);

const std::vector<std::string>& plate_columns();
const std::vector<std::string>& plate_columns_of_programmes();  ///< additional columns

/// Prescribed force at each row of plate.csv [N]; empty if the programme does not prescribe one.
std::vector<std::optional<double>> set_forces(const Recording& recording);
/// A row of plate.csv: its place and its prescribed force.
struct PlateRow {
    long line = 0;
    std::optional<double> set_force;  ///< [N]
};
/// Reports rows that do not match the scans of the recording's programme.
void check_programme(Table& table, const std::vector<PlateRow>& rows, const Recording& recording);
const std::vector<std::string>& grain_columns();
const std::vector<std::string>& contact_columns();

}  // namespace mcdem::experiment
