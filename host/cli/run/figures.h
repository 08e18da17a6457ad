// Pages and figures, which the Python package makes of results.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace mcdem::inline cli {

/// Throws InputError if figures.json or a figure with one of these names exists and was not written by mcdem.
void expect_replaceable_figures(const std::filesystem::path& folder, const std::vector<std::string>& names);

/// Runs the module mcdem.report.NAME with these arguments, which presents results that are written already.
/// Throws RunError if Python is missing or fails, Interrupted.
void present(const std::string& name, const std::vector<std::string>& arguments);

}  // namespace mcdem::cli
