// Tables of runs and comparisons; of programmes scan by scan: forces and displacements of a plate, stresses
// and strains of a cell.
#pragma once
#include "metrics/compare.h"
#include "metrics/model_table.h"
#include "metrics/scaling.h"
#include "report/page/text_table.h"

namespace mcdem::inline report {

/// "0.430 ± 0.012"; without the error if it is unknown, a dash without a value. More decimals if fewer than
/// two significant digits would be left, of the value or of a larger error.
std::string with_error(const Estimate& estimate, int decimals, double unit = 1);

/// Top force at full stroke (or at the last scan, marked) and its ratio to the reference setting.
TextTable table_of_models(const ModelTable& models);

/// table_of_models as CSV: one row per setting, with a column for each scene key that varies.
std::string csv_of_models(const ModelTable& models, const std::vector<Setting>& settings);

/// Table I of the paper, one row per setting, with notes on unavailable data.
TextTable table_of_comparisons(const std::vector<Comparison>& comparisons);

/// Coefficient, R^2 and curvature of the scaling law by setting and phase.
TextTable table_of_scaling(const std::vector<Setting>& settings);

/// One table for plates and one for cells, if there are any, with notes.
std::vector<TextTable> tables_of_scans(const std::vector<Setting>& settings);

/// The same as CSV, with standard errors and a column for each scene key that varies. Throws InputError if
/// some are cells and some are not.
std::string csv_of_scans(const std::vector<Setting>& settings);

}  // namespace mcdem::report
