// Programmes scan by scan: forces and displacements of a plate, stresses and strains of a cell.
#pragma once
#include <string>
#include <vector>

#include "metrics/programmes.h"
#include "report/page/text_table.h"

namespace mcdem::inline report {

/// One of plates, one of cells, where there are any; what should be known of them below.
std::vector<TextTable> tables_of_scans(const std::vector<Setting>& settings);

/// The same for programs, with standard errors, and a column for each scene key that is not the same in all.
/// Throws InputError where some are cells and some are not.
std::string csv_of_scans(const std::vector<Setting>& settings);

}  // namespace mcdem::report
