// Energy budget of runs as a table.
#pragma once
#include <vector>

#include "metrics/replicas.h"
#include "report/page/text_table.h"

namespace mcdem::inline report {

/// One row per setting: work, stored energy and losses at the scan with the largest elastic energy, means
/// over replicas [mJ]. No rows without budgets, as in measured data and runs of earlier versions.
TextTable table_of_energies(const std::vector<Setting>& settings);

}  // namespace mcdem::report
