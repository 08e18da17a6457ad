// Charts of a diagnosis: location of the gap, consistent effects, and gap reduction.
#pragma once
#include <optional>

#include "diagnose/decide/diagnosis.h"
#include "report/page/page.h"

namespace mcdem::inline report {

/// Heat map before and after recalibration, with significant cells framed. Nothing without cells.
std::optional<Chart> where_chart(const Diagnosis& diagnosis);

/// Candidates by score, with their amplitudes over the detection limits. Nothing without a ranking.
std::optional<Chart> which_chart(const Diagnosis& diagnosis);

/// Top force and remaining gap. Empty without a gap reduction, or if the held-out data show no gap.
std::vector<Chart> how_far_charts(const Diagnosis& diagnosis);

}  // namespace mcdem::report
