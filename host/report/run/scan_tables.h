// Programmes scan by scan: forces and displacements of a plate, stresses and strains of a cell.
#pragma once
#include <string>
#include <vector>

#include "metrics/programmes.h"
#include "report/page/text_table.h"

namespace mcdem::inline report {

/// One table for plates and one for cells, if there are any, with notes.
std::vector<TextTable> tables_of_scans(const std::vector<Setting>& settings);

/// The same as CSV, with standard errors and a column for each scene key that varies. Throws InputError if
/// some are cells and some are not.
std::string csv_of_scans(const std::vector<Setting>& settings);

}  // namespace mcdem::report
