// The plotting library in reports: plotly.js, an installed file.
#pragma once
#include <string>

namespace mcdem::inline report {

/// plotly.js, compressed with gzip. It is searched in $MCDEM_SHARE, in share/mcdem next to the program or
/// next to its folder, and in the installation folder. Throws RunError if it is not found.
std::string packed_plotting_library();

}  // namespace mcdem::report
