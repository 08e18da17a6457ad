// Drives gnuplot: text made safe for its scripts, and the program started without a shell.
#pragma once
#include <filesystem>
#include <string>

namespace mcdem::gnuplot {

/// A string constant of gnuplot's language that stands for the text, whatever the text holds.
std::string quoted(const std::string& text);

/// A CSV field: quoted where it must be.
std::string csv_field(const std::string& text);

/// A number for CSV; empty where it is not finite.
std::string csv_number(double value);

/// Runs `script` in `folder`. Throws RunError where gnuplot is missing or fails, with what it said.
void run(const std::filesystem::path& folder, const std::string& script);

}  // namespace mcdem::gnuplot
