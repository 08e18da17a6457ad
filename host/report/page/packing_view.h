// Data of the 3D view of a packing on a page, drawn by page_packing.js.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/recording.h"
#include "report/page/page.h"

namespace mcdem::inline report {

struct ShownPacking {
    std::string label;
    Recording recording;  ///< the selected scans, with positions and contacts
};

struct PackingLimits {
    std::optional<int> scans = std::nullopt;  ///< maximum for each packing; default: as many as fit
    long max_numbers = 600'000;               ///< of all packings together, about 3 MB
    int max_grains = 20'000;                  ///< of a packing: those nearest to its middle plane
};

/// Selects scans of a recording, evenly spaced, including the first, the last and that of the largest load
/// (stress_strain.h) if possible. `numbers`: numbers per scan of all packings together.
std::vector<std::size_t> scans_shown(const Recording& recording, long numbers,
                                     const PackingLimits& limits = {});

long numbers_of_scan(long grains, long contacts);

/// Input of page_packing.js: lengths in mm, forces in mN, with five digits. The colour scale ends at the
/// quantile of 0.995 of the forces. `strongest`: the scan at which a page opens. Nothing if no scan has
/// positions.
std::optional<Json> packing_view(const std::vector<ShownPacking>& packings, const PackingLimits& limits = {});

}  // namespace mcdem::report
