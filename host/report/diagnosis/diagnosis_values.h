// What the figures of a diagnosis show, as JSON (figure_values.h): where, which and how_far, those that there
// are.
#pragma once
#include <nlohmann/json.hpp>

#include "diagnose/decide/diagnosis.h"

namespace mcdem::inline report {

nlohmann::ordered_json diagnosis_figure_values(const Diagnosis& diagnosis);

}  // namespace mcdem::report
