// Values of figures as JSON: the file figures.json, which the Python package mcdem.figures draws. One key per
// figure, with the name of the picture file; numbers in the units of the axes, null if unknown.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "report/run/run_figures.h"

namespace mcdem::inline report {

nlohmann::ordered_json figure_values(const RunFigures& figures, const FigureData& data);

std::string figure_file(const nlohmann::ordered_json& figures);

}  // namespace mcdem::report
