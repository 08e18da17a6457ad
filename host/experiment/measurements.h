// The tables of an experiment folder, each into the scans of a recording.
#pragma once
#include "experiment/experiment.h"
#include "experiment/table.h"

namespace mcdem::inline experiment {

/// A scan of which nothing is known yet: not-a-number throughout, measured at rest.
Scan unknown_scan();
// `youngs_modulus` of the grains [Pa], infinite where not known: no force can be larger than it allows.

/// plate.csv: one scan a row. Of a programme (in the recording's parameters) the rows must be its scans.
void read_plate(Table& table, double youngs_modulus, Recording& recording);
/// grains.csv: diameters from frame 0, positions of the frames it lists.
void read_grains(Table& table, Recording& recording);
/// contacts.csv: contacts of the frames it lists.
void read_contacts(Table& table, double youngs_modulus, Recording& recording);
/// Wall forces other than the plate's, Z, <f> and <b> of the scans with contacts.
void average_contacts(Recording& recording, double force_threshold);

const std::vector<std::string>& plate_columns();
const std::vector<std::string>& plate_columns_of_programmes();  ///< beside them

/// What the programme sets at a row of plate.csv [N]; nothing where it sets no force.
std::vector<std::optional<double>> set_forces(const Recording& recording);
/// A row of plate.csv: where it stands, and the force that it says was set.
struct PlateRow {
    long line = 0;
    std::optional<double> set_force;  ///< [N]
};
/// Reports rows that are not the scans of the recording's programme.
void check_programme(Table& table, const std::vector<PlateRow>& rows, const Recording& recording);
const std::vector<std::string>& grain_columns();
const std::vector<std::string>& contact_columns();

}  // namespace mcdem::experiment
