// Values of the available figures of a diagnosis as JSON (figure_values.h): where, which and how_far.
#pragma once
#include <nlohmann/json.hpp>

#include "diagnose/decide/diagnosis.h"

namespace mcdem::inline report {

nlohmann::ordered_json diagnosis_figure_values(const Diagnosis& diagnosis);

}  // namespace mcdem::report
