// Pages and figures, which the Python package makes of results.
#pragma once
#include <string>
#include <vector>

namespace mcdem::inline cli {

/// Runs the module mcdem.report.NAME with these arguments, which presents results that are written already.
/// Throws RunError if Python is missing or fails, Interrupted.
void present(const std::string& name, const std::vector<std::string>& arguments);

}  // namespace mcdem::cli
