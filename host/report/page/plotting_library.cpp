#include "report/page/plotting_library.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "core/errors.h"

namespace mcdem::inline report {
namespace {

namespace fs = std::filesystem;

constexpr const char* file_name = "plotly.js.gz";

/// Only $MCDEM_SHARE if it is set, so that a wrong value is noticed.
std::vector<fs::path> folders() {
    if (const char* chosen = std::getenv("MCDEM_SHARE")) return {chosen};
    std::error_code unknown;
    const auto program = fs::read_symlink("/proc/self/exe", unknown).parent_path();
    return {program / "share/mcdem", program.parent_path() / "share/mcdem", MCDEM_INSTALLED_SHARE};
}

}  // namespace

std::string packed_plotting_library() {
    std::string looked;
    for (const auto& folder : folders()) {
        std::ifstream in(folder / file_name, std::ios::binary);
        std::string bytes{std::istreambuf_iterator<char>(in), {}};
        if (bytes.starts_with("\x1f\x8b")) return bytes;  // magic number of gzip
        looked += (looked.empty() ? "" : ", ") + folder.string();
    }
    throw RunError(
        std::string("the plotting library of reports, ") + file_name + ", is in none of " + looked +
        ": install python3-plotly, then build and install mcdem again, or let MCDEM_SHARE name the "
        "folder that holds it");
}

}  // namespace mcdem::report
