// A convergence as a table, a verdict in words, JSON and a figure.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "diagnose/infer/convergence.h"
#include "report/page/text_table.h"

namespace mcdem::inline report {

/// Row: observable; column: cause. Each the largest error over phases and displacements with its standard
/// error, in per cent for forces and in standard deviations of one packing's replicates for all else; a star
/// where it is beyond its limit.
TextTable table_of_convergence(const Convergence& convergence);

/// One line a cause: "top force 1.3 +- 0.2 % high .. by the plate speed: set ..", or that all is within the
/// limits.
std::vector<std::string> words_of_convergence(const Convergence& convergence);

std::string convergence_json(const Convergence& convergence);

/// What its figure shows (figure_values.h): errors of every observable by the causes, over their limits.
nlohmann::ordered_json convergence_figure_values(const Convergence& convergence);

}  // namespace mcdem::report
