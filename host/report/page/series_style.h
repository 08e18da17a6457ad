// Colours and markers of series, the same on pages and in figures for print.
#pragma once
#include <string>
#include <vector>

#include "metrics/replicas.h"

namespace mcdem::inline report {

struct SeriesStyle {
    std::string colour;  ///< "#rrggbb"
    std::string marker;  ///< in the terms of matplotlib
};

/// Black circles: what simulations are compared with.
SeriesStyle reference_style();

/// Of the first, second, .. series. Colours that the colour-blind can tell apart (Okabe and Ito).
SeriesStyle style_number(std::size_t index);

/// A contact model keeps its colour from figure to figure where every setting has another model; else colours
/// follow the order of the settings.
std::vector<SeriesStyle> styles_of(const std::vector<Setting>& settings);

}  // namespace mcdem::report
