// The tables of an experiment folder, each into the scans of a recording.
#pragma once
#include "experiment/experiment.h"
#include "experiment/table.h"

namespace mcdem::inline experiment {

/// A scan of which nothing is known yet: not-a-number throughout, measured at rest.
Scan unknown_scan();
// `youngs_modulus` of the grains [Pa], infinite where not known: no force can be larger than it allows.

/// plate.csv: one scan a row.
void read_plate(Table& table, double youngs_modulus, Recording& recording);
/// grains.csv: diameters from frame 0, positions of the frames it lists.
void read_grains(Table& table, Recording& recording);
/// contacts.csv: contacts of the frames it lists.
void read_contacts(Table& table, double youngs_modulus, Recording& recording);
/// Wall forces other than the plate's, Z, <f> and <b> of the scans with contacts.
void average_contacts(Recording& recording, double force_threshold);

const std::vector<std::string>& plate_columns();
const std::vector<std::string>& grain_columns();
const std::vector<std::string>& contact_columns();

}  // namespace mcdem::experiment
