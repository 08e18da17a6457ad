// The pictures of a diagnosis as charts of a page.
#pragma once
#include "diagnose/decide/diagnosis.h"
#include "report/page/page.h"

namespace mcdem::inline report {

/// Those that there are. where: a heat map before and after recalibration, cells that stand out framed.
/// which: candidates by score, with their amplitudes over what these data can detect. how_far: the top force.
/// gap_left: the gap before and after; neither where the data held out show none.
std::vector<Chart> diagnosis_charts(const Diagnosis& diagnosis);

}  // namespace mcdem::report
