// The tables that a run and a comparison end with.
#pragma once
#include "metrics/compare.h"
#include "metrics/model_table.h"
#include "metrics/scaling.h"
#include "report/page/text_table.h"

namespace mcdem::inline report {

/// "0.430 ± 0.012"; without its error where that is not known, a dash where there is no value.
std::string with_error(const Estimate& estimate, int decimals, double unit = 1);

/// Top force at full stroke, or at its last scan with a mark, and over the reference setting's.
TextTable table_of_models(const ModelTable& models);

/// Scan by scan: time, displacement, force and Z of settings that follow a programme.
TextTable table_of_scans(const std::vector<Setting>& settings);

/// The same as table_of_models for programs: a row a setting, with a column for each scene key that is not
/// the same in all.
std::string csv_of_models(const ModelTable& models, const std::vector<Setting>& settings);

/// The paper's Table I, one row a setting, with what was not available below.
TextTable table_of_comparisons(const std::vector<Comparison>& comparisons);

/// Coefficient, R^2 and curvature of the scaling law by setting and phase.
TextTable table_of_scaling(const std::vector<Setting>& settings, const LevelOptions& options = {});

}  // namespace mcdem::report
