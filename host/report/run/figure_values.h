// What figures show, as JSON: the file figures.json that the Python package mcdem.figures draws. A key a
// figure, named like the file of its picture; numbers in the units of the axes, null where they are not
// known.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "report/run/run_figures.h"

namespace mcdem::inline report {

nlohmann::ordered_json figure_values(const RunFigures& figures, const Cast& cast);

/// The text of the file.
std::string figure_file(const nlohmann::ordered_json& figures);

}  // namespace mcdem::report
