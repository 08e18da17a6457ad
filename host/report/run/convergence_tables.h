// Results of `mcdem converge` as a table, sentences, JSON and a figure.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "diagnose/infer/convergence.h"
#include "report/page/text_table.h"

namespace mcdem::inline report {

/// Row: observable; column: cause. The largest error over phases and displacements with its standard error,
/// in per cent for forces, otherwise in standard deviations of one packing's replicates; a star marks values
/// beyond their limit.
TextTable table_of_convergence(const Convergence& convergence);

/// One line per cause: "top force 1.3 +- 0.2 % high .. by the plate speed: set ..", or that all errors are
/// within the limits.
std::vector<std::string> words_of_convergence(const Convergence& convergence);

std::string convergence_json(const Convergence& convergence);

/// Values of its figure (figure_values.h): errors of every observable from each cause, over their limits.
nlohmann::ordered_json convergence_figure_values(const Convergence& convergence);

}  // namespace mcdem::report
