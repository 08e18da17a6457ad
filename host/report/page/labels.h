// How settings are called, and stresses told, where people read them.
#pragma once
#include <string>

namespace mcdem::inline report {

/// Stands where a number is not known.
inline const std::string no_number = "–";

/// Of numbers that are told in millimetres and millinewtons.
constexpr double mm = 1e-3, mN = 1e-3;

/// Contact models in words ("mc_dem, gamma = 1" becomes "MC-DEM, gamma = 1"); other labels as they are.
std::string words_for(const std::string& label);

/// One line without control characters: what a label from a file may hold must not steer a terminal,
/// break a table or end a script's line.
std::string one_line(const std::string& text);

/// The text cut to `most` characters of UTF-8, with an ellipsis where something is missing.
std::string shortened(const std::string& text, std::size_t most);

/// A unit in which the largest of some stresses has few digits.
struct StressUnit {
    const char* name;
    double size;  ///< [Pa]
};
StressUnit stress_unit(double largest);

}  // namespace mcdem::report
