// Values of the available figures of a diagnosis as JSON (figure_values.h): where, which and how_far.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "diagnose/decide/diagnosis.h"

namespace mcdem::inline report {

nlohmann::ordered_json diagnosis_figure_values(const Diagnosis& diagnosis);

/// Whether "where" frames the cell. Where the threshold is not known, the cells of the entries stand out
/// before recalibration, and none after.
bool stands_out(const Diagnosis& diagnosis, const WhereCell& cell, bool refitted);

/// Candidates that these data cannot tell apart share a letter: "A", "AB", empty where one stands alone. By
/// place in the ranking.
std::vector<std::string> group_letters(const std::vector<Cause>& ranking);

}  // namespace mcdem::report
