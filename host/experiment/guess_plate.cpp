// Units and sign of the plate's table: its position by the grains below it, its force by theirs on it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiment/findings.h"
#include "experiment/guess.h"

namespace mcdem {
namespace {

/// The plate's table as it stands, in the units m and N.
PlateRows plain_rows(const ImportTable& table, double plate_start) {
    ImportTable plain = table;
    plain.map.entries["length_unit"] = guess("m", Sure::stated, "");
    plain.map.entries["force_unit"] = guess("N", Sure::stated, "");
    plain.map.entries["force_sign"] = guess("+", Sure::stated, "");
    ExperimentProblems ignored;
    return import_plate(plain, plate_start, ignored);
}

/// The plate's row that belongs to a frame of the grains; -1 where none does. Frames are placed by the first
/// table that is taken for the plate's; a second one may be shorter.
int row_of(const PlateRows& plate, const GrainFrames& grains, std::size_t frame) {
    const int row = grains.row.empty() ? plate.index.find(grains.keys[frame]) : grains.row[frame];
    return row < static_cast<int>(plate.scans.size()) ? row : -1;
}

/// A plate below 0 counts from somewhere else than the floor, and so may one that counts downwards and does
/// not rest on the grains at its lowest.
void guess_plate_origin(MappedTable& map, const PlateRows& plate, const GrainFrames& grains,
                        const std::string& grains_unit) {
    constexpr double near = 0.15;  // of the height
    if (!map.has("plate_z")) return;
    const auto lowest = std::ranges::min_element(plate.scans, {}, &Scan::plate_z);
    double top = 0;
    for (std::size_t f = 0; f < grains.keys.size(); ++f)
        if (row_of(plate, grains, f) == lowest - plate.scans.begin()) top = grains.top(f);
    const std::string word = map.word("plate_z", "");
    const auto [sign, column] = signed_column(word);
    const bool rests =
        top > 0 &&
        !fitting_units(length_units, length_factor, lowest->plate_z, top, 1 - near, 1 + near).empty();
    if (lowest->plate_z > 0 && (sign > 0 || rests)) return;
    const double unit = length_factor(map.word("length_unit", grains_unit));
    map.entries["origin_z"] = guess(
        top > 0 ? fmt::format("{:.6g}", sign * (lowest->plate_z - top / unit)) : "0", Sure::unclear,
        fmt::format(
            "counted from 0 the plate would be at {:.4g} at the lowest: where is the floor, as {} counts?",
            lowest->plate_z, column));
}

void guess_height(ImportTable& table, const PlateRows& plate, const GrainFrames& grains, double plate_start) {
    MappedTable& map = table.map;
    const bool goes_down = map.has("displacement");
    std::vector<std::string> fits;
    std::string seen;
    if (!grains.keys.empty() && (!goes_down || std::isfinite(plate_start))) {
        // At the frame with the lowest plate: it rests on the grains there.
        std::size_t lowest = 0;
        double lowest_z = INFINITY;
        for (std::size_t f = 0; f < grains.keys.size(); ++f)
            if (const int row = row_of(plate, grains, f);
                row >= 0 && plate.scans[static_cast<std::size_t>(row)].plate_z < lowest_z)
                lowest = f, lowest_z = plate.scans[static_cast<std::size_t>(row)].plate_z;
        const double top = grains.top(lowest);
        const double first_top = grains.top(0);
        if (std::isfinite(lowest_z) && !goes_down) {
            fits = fitting_units(length_units, length_factor, lowest_z, top, 0.6, 1.6);
            seen = fmt::format("at the lowest the plate is at {:.4g}, the grains reach up to {:.4g} m",
                               lowest_z, top);
        } else if (std::isfinite(lowest_z)) {
            const double down = plate_start - lowest_z;
            for (const std::string unit : {"m", "cm", "mm", "um"})
                if (const double z = plate_start - down * length_factor(unit);
                    z > 0.85 * top && z < 1.15 * top &&
                    down * length_factor(unit) > 0.3 * (first_top - top) - 1e-12)
                    fits.push_back(unit);
            seen = fmt::format("displacements reach {:.4g}, the grains sink from {:.4g} to {:.4g} m", down,
                               first_top, top);
        }
    }
    const Guess* named = map.find("length_unit");
    if (named && named->sure == Sure::unclear) return;
    if (named && (fits.empty() ? seen.empty() : std::ranges::find(fits, named->word()) != fits.end())) return;
    if (named)
        map.entries["length_unit"] =
            guess(named->word(), Sure::unclear, "the columns' names say so, but " + seen);
    else if (fits.size() == 1)
        map.entries["length_unit"] = guess(fits.front(), Sure::sure, seen);
    else
        map.entries["length_unit"] = guess(
            fits.empty() ? "m" : fits.front(), Sure::unclear,
            seen.empty()
                ? goes_down ? "no name says it, and plate.start is not known: --set plate.start=.. would tell"
                            : "no name says it, and there are no grains to compare with"
                : seen);
}

/// Force of the grains on the plate in each of their frames, from their contacts with it; not-a-number where
/// none is listed.
std::vector<double> contact_forces(const std::vector<ImportTable>& tables, const GrainFrames& grains) {
    std::vector<double> sums(grains.keys.size(), std::nan(""));
    for (const ImportTable& table : tables) {
        const Guess* unit = table.map.find("force_unit");
        if (table.map.role != Role::contacts || !unit || unit->sure == Sure::unclear) continue;
        ExperimentProblems ignored;
        const ContactFrames frames = import_contacts(table, grains, ignored);
        for (std::size_t f = 0; f < frames.keys.size(); ++f) {
            const int frame = grains.frame_of(table.map.word("frames_by", "plate"), frames.keys[f], f);
            if (frame < 0) continue;
            double& sum = sums[static_cast<std::size_t>(frame)];
            for (const auto& one : frames.contacts[f])
                if (one.contact.partner == wall_partner(Wall::plate))
                    sum = (std::isnan(sum) ? 0 : sum) - one.contact.force.z();
        }
    }
    return sums;
}

double hertz_on_plate(const Experiment& known, const GrainFrames& grains, std::size_t frame, double plate_z) {
    double sum = 0;
    for (std::size_t i = 0; i < grains.diameter.size(); ++i) {
        const double radius = grains.diameter[i] / 2,
                     overlap = grains.position[frame][i].z() + radius - plate_z;
        if (overlap > 0) sum += hertz_force(known, radius, 0, overlap);
    }
    return sum;
}

/// Median over the loaded frames of the table's force over the one that `truth` gives.
template <class Truth>
double force_ratio(const PlateRows& plate, const GrainFrames& grains, const Truth& truth) {
    double largest = 0;
    for (const Scan& scan : plate.scans) largest = std::max(largest, std::abs(scan.top_force()));
    std::vector<double> ratios;
    for (std::size_t f = 0; f < grains.keys.size(); ++f) {
        const int row = row_of(plate, grains, f);
        if (row < 0) continue;
        const Scan& scan = plate.scans[static_cast<std::size_t>(row)];
        const double expected = truth(f, scan);
        if (std::abs(scan.top_force()) > 0.2 * largest && expected > 0)
            ratios.push_back(std::abs(scan.top_force()) / expected);
    }
    return ratios.empty() ? std::nan("") : median(std::move(ratios));
}

void guess_force(ImportTable& table, const std::vector<ImportTable>& others, const PlateRows& plate,
                 const GrainFrames& grains, const Experiment& known) {
    MappedTable& map = table.map;
    double low = INFINITY, high = -INFINITY;
    for (const Scan& scan : plate.scans)
        low = std::min(low, scan.top_force()), high = std::max(high, scan.top_force());
    const bool down = std::abs(low) > std::abs(high);
    const bool clear =
        std::min(std::abs(low), std::abs(high)) < 0.3 * std::max(std::abs(low), std::abs(high));
    map.entries["force_sign"] =
        guess(down ? "-" : "+", clear ? Sure::sure : Sure::unclear,
              fmt::format("forces reach from {:.4g} to {:.4g}, and the grains push", low, high));
    const auto sums = contact_forces(others, grains);
    const double sum = force_ratio(plate, grains, [&](std::size_t f, const Scan&) { return sums[f]; });
    const double hertz = force_ratio(plate, grains, [&](std::size_t f, const Scan& scan) {
        return hertz_on_plate(
            known, grains, f,
            scan.plate_z * (map.has("displacement") ? 1 : length_factor(map.word("length_unit", "m"))));
    });
    const bool by_sum = std::isfinite(sum);
    const double ratio = by_sum ? sum : hertz;
    const auto fits = by_sum ? fitting_units(force_units, force_factor, ratio, 1, 0.6, 1.6)
                             : fitting_units(force_units, force_factor, ratio, 1, 1 / 3.1, 3.1);
    const std::string seen = !std::isfinite(ratio)
                                 ? std::string()
                                 : fmt::format("the largest forces are {:.3g} times those {} [N]", ratio,
                                               by_sum ? "of the contacts with the plate"
                                                      : "of Hertz from the overlaps with the plate");
    const Guess* named = map.find("force_unit");
    if (named && named->sure == Sure::unclear) return;
    if (named && (!by_sum || std::ranges::find(fits, named->word()) != fits.end())) return;
    if (named)
        map.entries["force_unit"] =
            guess(named->word(), Sure::unclear, "the columns' names say so, but " + seen);
    else if (fits.size() == 1)
        map.entries["force_unit"] =
            guess(fits.front(), by_sum || hertz_tells(fits.front()) ? Sure::sure : Sure::unclear, seen);
    else
        map.entries["force_unit"] =
            guess("N", Sure::unclear,
                  seen.empty() ? "no name says it, and nothing is known to compare with" : seen);
}

}  // namespace

void guess_plate_units(ImportTable& table, const std::vector<ImportTable>& others, const GrainFrames& grains,
                       const Experiment& known) {
    if (!table.map.has("top_force") || (!table.map.has("plate_z") && !table.map.has("displacement"))) return;
    const double start = known.recording.plate_start;
    const auto rows = [&] { return plain_rows(table, std::isfinite(start) ? start : 0); };
    PlateRows plate = rows();
    if (plate.scans.empty()) return;
    guess_plate_downwards(table.map, plate.scans);
    plate = rows();
    const auto of_grains =
        std::ranges::find(others, Role::grains, [](const ImportTable& other) { return other.map.role; });
    guess_plate_origin(table.map, plate, grains,
                       of_grains == others.end() ? "m" : of_grains->map.word("length_unit", "m"));
    plate = rows();
    guess_height(table, plate, grains, start);
    guess_force(table, others, plate, grains, known);
}

}  // namespace mcdem
