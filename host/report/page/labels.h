// Readable names of settings, and units of stresses.
#pragma once
#include <string>

namespace mcdem::inline report {

/// Shown for an unknown number.
inline const std::string no_number = "–";

/// Units of numbers shown in millimetres and millinewtons.
constexpr double mm = 1e-3, mN = 1e-3;

/// Replaces contact models by their full names ("mc_dem, gamma = 1" becomes "MC-DEM, gamma = 1"); other
/// labels do not change.
std::string words_for(const std::string& label);

/// Removes line breaks and control characters, so that a label from a file cannot control a terminal, break a
/// table or end a line of a script.
std::string one_line(const std::string& text);

/// The text truncated to `most` UTF-8 characters, with an ellipsis if it was longer.
std::string shortened(const std::string& text, std::size_t most);

/// A unit in which the largest of several stresses has few digits.
struct StressUnit {
    const char* name;
    double size;  ///< [Pa]
};
StressUnit stress_unit(double largest);

}  // namespace mcdem::report
