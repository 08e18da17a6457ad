// Colours and markers of series, for pages and for figures for print.
#pragma once
#include <string>
#include <vector>

#include "metrics/replicas.h"

namespace mcdem::inline report {

struct SeriesStyle {
    std::string colour;  ///< "#rrggbb"
    std::string marker;  ///< as in matplotlib
};

/// Black circles, for the reference.
SeriesStyle reference_style();

/// Style of the first, second, .. series. The colours are suitable for colour-blind readers (Okabe and Ito).
SeriesStyle style_number(std::size_t index);

/// If every setting has a different contact model, a model has the same colour in all figures; otherwise
/// colours follow the order of the settings.
std::vector<SeriesStyle> styles_of(const std::vector<Setting>& settings);

}  // namespace mcdem::report
