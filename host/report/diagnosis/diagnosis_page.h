// A diagnosis on a page.
#pragma once
#include <filesystem>
#include <string>

#include "diagnose/decide/diagnosis.h"
#include "report/page/page.h"

namespace mcdem::inline report {

/// Verdict, charts, tables and provenance; `name` tells it from others on the page, empty: it stands alone.
void add_diagnosis(Page& page, const Diagnosis& diagnosis, const std::string& name);

/// A page of this diagnosis alone. Throws RunError where it cannot be made.
void write_diagnosis_page(const Diagnosis& diagnosis, const std::filesystem::path& file);

}  // namespace mcdem::report
