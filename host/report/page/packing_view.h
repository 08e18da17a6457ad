// The packing in space, made ready for a page: what page_packing.js draws.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/recording.h"
#include "report/page/page.h"

namespace mcdem::inline report {

/// One setting's packing, with some of its scans.
struct ShownPacking {
    std::string label;
    Recording recording;  ///< the scans that are shown, with their positions and contacts
};

/// How much of a packing a page carries.
struct PackingLimits {
    std::optional<int> scans = std::nullopt;  ///< at most so many of each packing; none: as many as find room
    long max_numbers = 600'000;               ///< in all packings together, about 3 MB
    int max_grains = 20'000;                  ///< of a packing: those nearest to its middle plane
};

/// Which of a recording's scans are shown: evenly spread, the first, the last and the strongest one
/// (stress_strain.h) among them where there is room. `numbers`: how many numbers a scan of all packings
/// together has.
std::vector<std::size_t> scans_shown(const Recording& recording, long numbers,
                                     const PackingLimits& limits = {});

/// Numbers that a scan with so many grains and contacts takes.
long numbers_of_scan(long grains, long contacts);

/// What page_packing.js draws: lengths in mm, forces in mN, five digits of either; colours end at the force
/// that all but one contact in two hundred stay below; `strongest`: the scan that a page opens at. Nothing
/// where no scan has positions.
std::optional<Json> packing_view(const std::vector<ShownPacking>& packings, const PackingLimits& limits = {});

}  // namespace mcdem::report
