// Readable names of settings, their colours and markers, and units of stresses. For pages and figures for
// print.
#pragma once
#include <string>
#include <vector>

#include "metrics/replicas.h"

namespace mcdem::inline report {

inline const std::string no_number = "–";

constexpr double mm = 1e-3, mN = 1e-3;

/// Replaces contact models by their full names ("mc_dem, gamma = 1" becomes "MC-DEM, gamma = 1"); other
/// labels do not change.
std::string words_for(const std::string& label);

/// Removes line breaks and control characters, so that a label from a file cannot control a terminal, break a
/// table or end a line of a script.
std::string one_line(const std::string& text);

/// The text truncated to `most` UTF-8 characters, with an ellipsis if it was longer.
std::string shortened(const std::string& text, std::size_t most);

/// Three significant digits, without an exponent from 1e-4 to a million: "0.0123", "1000" for 999.9.
std::string three_digits(double value);

/// A unit in which the largest of several stresses has few digits.
struct StressUnit {
    const char* name;
    double size;  ///< [Pa]
};
StressUnit stress_unit(double largest);

struct SeriesStyle {
    std::string colour;  ///< "#rrggbb"
    std::string marker;  ///< as in matplotlib
};

/// Black circles, for the reference.
SeriesStyle reference_style();

/// Style of the first, second, .. series.
SeriesStyle style_number(std::size_t index);

/// If every setting has a different contact model, a model has the same colour in all figures; otherwise
/// colours follow the order of the settings, with a gradual change if there are more than seven. They are
/// suitable for colour-blind readers (Okabe and Ito; viridis).
std::vector<SeriesStyle> styles_of(const std::vector<Setting>& settings);

}  // namespace mcdem::report
