// A diagnosis on a page.
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

}  // namespace mcdem::report
