// The plotting library that reports carry: plotly.js, a file of the installation.
#pragma once
#include <string>

namespace mcdem::inline report {

/// plotly.js as a gzip file's bytes. Looked for in $MCDEM_SHARE, in share/mcdem beside the program or beside
/// its folder, and where the installation put it. Throws RunError where it is in none of them.
std::string packed_plotting_library();

}  // namespace mcdem::report
