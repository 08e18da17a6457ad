#pragma once
#include <filesystem>
#include <string>

#include "diagnose/decide/diagnosis.h"
#include "report/page/page.h"

namespace mcdem::inline report {

/// Adds verdict, charts, tables and provenance. `name` distinguishes several diagnoses on a page; empty for a
/// single one.
void add_diagnosis(Page& page, const Diagnosis& diagnosis, const std::string& name);

/// Writes a page with only this diagnosis. Throws RunError if that fails.
void write_diagnosis_page(const Diagnosis& diagnosis, const std::filesystem::path& file);

/// Those that there are. where: a heat map before and after recalibration, cells that stand out framed.
/// which: candidates by score, with their amplitudes over what these data can detect. how_far: the top force.
/// gap_left: the gap before and after; neither where the data held out show none.
std::vector<Chart> diagnosis_charts(const Diagnosis& diagnosis);

}  // namespace mcdem::report
