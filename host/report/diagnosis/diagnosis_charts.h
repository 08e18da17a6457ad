// The pictures of a diagnosis as charts of a page: where the gap is, which effects are consistent with it,
// how far it shrinks.
#pragma once
#include <optional>

#include "diagnose/decide/diagnosis.h"
#include "report/page/page.h"

namespace mcdem::inline report {

/// Heat map before and after recalibration, cells that stand out framed. Nothing without cells.
std::optional<Chart> where_chart(const Diagnosis& diagnosis);

/// Candidates by score, with their amplitudes over what these data can detect. Nothing without a ranking.
std::optional<Chart> which_chart(const Diagnosis& diagnosis);

/// Top force, and the gap that is left. Empty without a reduction of the gap, or where the data held out show
/// no gap.
std::vector<Chart> how_far_charts(const Diagnosis& diagnosis);

}  // namespace mcdem::report
