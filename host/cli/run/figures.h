// Pages and figures, which the Python package makes of results.
#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace mcdem::inline cli {

/// Throws InputError if figures.json or a figure with one of these names exists and was not written by mcdem.
void expect_replaceable_figures(const std::filesystem::path& folder, const std::vector<std::string>& names);

/// Writes `values` as figures.json into `folder`, which must exist, and draws NAME.pdf, NAME.png and NAME.svg
/// of each (host/python/mcdem/figures). Returns the PNG files. Throws InputError as above, RunError if Python
/// fails.
std::vector<std::filesystem::path> draw_figures(const std::filesystem::path& folder,
                                                const nlohmann::ordered_json& values);

/// For commands with other results: errors are only reported.
std::vector<std::filesystem::path> draw_if_possible(
    const std::function<std::vector<std::filesystem::path>()>& draw);

/// Runs the module mcdem.report.NAME with these arguments, which presents results that are written already.
/// Throws RunError if Python is missing or fails, Interrupted.
void present(const std::string& name, const std::vector<std::string>& arguments);

}  // namespace mcdem::cli
