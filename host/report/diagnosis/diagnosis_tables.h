// The tables of a diagnosis, for a terminal or a page.
#pragma once
#include "diagnose/decide/diagnosis.h"
#include "report/page/text_table.h"

namespace mcdem::inline report {

TextTable table_of_causes(const Diagnosis& diagnosis);

/// Significant parts of the data, strongest first, at most 20.
TextTable table_of_where(const Diagnosis& diagnosis);

TextTable table_of_detection_limits(const Diagnosis& diagnosis);

/// Each of several packings separately; no rows for a single one.
TextTable table_of_packings(const Diagnosis& diagnosis);

/// Fitted shifts of the uncertain parameters.
TextTable table_of_nuisances(const Diagnosis& diagnosis);

/// Gap and metrics before and after; empty without a gap reduction.
TextTable table_of_gap_reduction(const Diagnosis& diagnosis);

TextTable table_of_provenance(const Diagnosis& diagnosis);

}  // namespace mcdem::report
