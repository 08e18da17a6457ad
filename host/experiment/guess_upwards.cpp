// Which way z counts in the tables of grains and plate. The plate presses from above, so where the packing
// gives way is its top; and the plate's force grows on its way down.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiment/column_names.h"
#include "experiment/findings.h"
#include "experiment/guess.h"

namespace mcdem {
namespace {

/// Where the surfaces of a frame's grains begin and end along z, as the column counts.
struct Ends {
    double low = INFINITY, high = -INFINITY;
    double height() const { return high - low; }
};

std::vector<Ends> ends_of(const GrainFrames& grains) {
    std::vector<Ends> all;
    for (const auto& position : grains.position) {
        Ends& ends = all.emplace_back();
        for (std::size_t i = 0; i < std::min(position.size(), grains.diameter.size()); ++i) {
            ends.low = std::min(ends.low, position[i].z() - grains.diameter[i] / 2);
            ends.high = std::max(ends.high, position[i].z() + grains.diameter[i] / 2);
        }
    }
    return all;
}

enum class Gives { nothing, low_end, high_end, both_ends };

/// The end that nears the other one from the highest frame to the lowest.
Gives end_that_gives(const std::vector<Ends>& frames, double diameter) {
    constexpr double least = 0.1;  // of a diameter: less may be noise
    constexpr double nearly_all = 0.8;
    const auto [lowest, highest] = std::ranges::minmax_element(frames, {}, &Ends::height);
    const double shrink = highest->height() - lowest->height();
    if (!(shrink > least * diameter)) return Gives::nothing;
    const double at_low = (lowest->low - highest->low) / shrink;
    return at_low > nearly_all       ? Gives::low_end
           : at_low < 1 - nearly_all ? Gives::high_end
                                     : Gives::both_ends;
}

/// What the ends and the column's name say of a table whose z is not turned yet.
Guess upwards(const std::string& column, const Guess& now, const std::vector<Ends>& frames, double diameter) {
    const Gives gives = end_that_gives(frames, diameter);
    const double margin = 0.12 * diameter;  // soft grains reach into the floor
    const Ends& first = frames.front();
    const std::string turned = "-" + column;
    const std::string reach = fmt::format("grains reach from {:.4g} to {:.4g}", first.low, first.high);
    const bool named_so = names_downwards(column_name(column));
    if (named_so && (gives == Gives::high_end || gives == Gives::both_ends))
        return guess(turned, Sure::unclear,
                     "its name says downwards, but the packing gives way at its upper end: remove the - if z "
                     "is upwards");
    if (named_so) return guess(turned, Sure::sure, "its name says downwards");
    if (gives == Gives::low_end && std::abs(first.high) < margin)
        return guess(turned, Sure::sure,
                     reach + ", and the packing gives way at its lower end: z is downwards");
    if (gives == Gives::low_end)
        return guess(
            turned, Sure::unclear,
            reach + ", and the packing gives way at its lower end: is z downwards? If not, remove the -");
    if (gives == Gives::both_ends)
        return guess(now.word(), Sure::unclear,
                     "the packing gives way at both ends: is z upwards, and does the floor stand still?");
    if (gives == Gives::nothing && first.high < margin && first.low < -margin)
        return guess(turned, Sure::unclear, reach + ": is z downwards? If not, remove the -");
    Guess same = now;
    if (gives == Gives::high_end && now.sure != Sure::unclear)
        same.why += "; upwards, for the packing gives way there";
    return same;
}

/// Rows by heights as they stand, the mean size of the force in the upper and the lower fifth.
std::pair<double, double> force_above_and_below(const std::vector<Scan>& scans) {
    constexpr double part = 0.2;
    const auto [low, high] = std::ranges::minmax(scans, {}, &Scan::plate_z);
    const double range = high.plate_z - low.plate_z;
    double above = 0, below = 0;
    long count_above = 0, count_below = 0;
    for (const Scan& scan : scans) {
        const double force = std::abs(scan.top_force());
        if (scan.plate_z >= high.plate_z - part * range) above += force, ++count_above;
        if (scan.plate_z <= low.plate_z + part * range) below += force, ++count_below;
    }
    return {above / static_cast<double>(count_above), below / static_cast<double>(count_below)};
}

}  // namespace

void guess_grains_upwards(std::vector<ImportTable>& tables) {
    std::vector<std::pair<MappedTable*, bool>> told;  // and whether the frames tell
    bool turned = false;
    for (ImportTable& table : tables) {
        if (table.map.role != Role::grains || !table.map.has("z")) continue;
        ImportTable plain = table;
        plain.map.entries["length_unit"] = guess("m", Sure::stated, "");
        ExperimentProblems ignored;
        const GrainFrames grains = import_grains({&plain}, ignored);
        if (grains.keys.empty() || grains.diameter.empty()) continue;
        const double diameter = median(grains.diameter);
        Guess& z = table.map.entries["z"];
        z = upwards(z.word(), z, ends_of(grains), diameter);
        told.emplace_back(&table.map, grains.keys.size() > 1);
        turned = turned || z.word().starts_with('-');
    }
    if (!turned) return;
    for (auto& [map, several] : told)
        if (Guess& z = map->entries["z"]; !several && !z.word().starts_with('-')) {
            z.sure = Sure::unclear;
            z.why = "it is downwards in another table: write a - before its name if it is here too";
        }
}

void guess_plate_downwards(MappedTable& map, const std::vector<Scan>& scans) {
    constexpr double much = 2;
    if (scans.size() < 3) return;
    const auto [above, below] = force_above_and_below(scans);
    if (!(above > much * below)) return;
    Guess& place = map.entries[map.has("displacement") ? "displacement" : "plate_z"];
    if (place.sure == Sure::unclear) return;
    place = guess(
        "-" + place.word(), Sure::sure,
        fmt::format(
            "its force is {:.4g} at the upper end and {:.4g} at the lower one if the column is taken as "
            "it is, and the plate presses on its way down",
            above, below));
}

}  // namespace mcdem
