// The tables of a diagnosis, for a terminal or a page.
#pragma once
#include "diagnose/decide/diagnosis.h"
#include "report/page/text_table.h"

namespace mcdem::inline report {

TextTable table_of_causes(const Diagnosis& diagnosis);

/// Parts of the data that stand out, the strongest first, at most 20 of them.
TextTable table_of_where(const Diagnosis& diagnosis);

TextTable table_of_detection_limits(const Diagnosis& diagnosis);

/// Each of several packings by itself; no rows where there is one.
TextTable table_of_packings(const Diagnosis& diagnosis);

/// How far the fit moved the parameters that are known only roughly.
TextTable table_of_nuisances(const Diagnosis& diagnosis);

/// Gap and metrics before and after; empty without a reduction of the gap.
TextTable table_of_gap_reduction(const Diagnosis& diagnosis);

TextTable table_of_provenance(const Diagnosis& diagnosis);

}  // namespace mcdem::report
