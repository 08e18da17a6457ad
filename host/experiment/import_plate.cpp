#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiment/column_names.h"
#include "experiment/import_tables.h"
#include "experiment/measurements.h"

namespace mcdem {
namespace {

constexpr double turn_over_stroke = 0.01;  // smaller steps back are noise, not a turn

std::optional<Phase> phase_of(std::string_view text) {
    const std::string word = column_name(text).base;
    for (const std::string_view load : {"load", "loading", "down", "compression", "compress", "belastung"})
        if (word == load) return Phase::load;
    for (const std::string_view unload :
         {"unload", "unloading", "up", "decompression", "decompress", "entlastung"})
        if (word == unload) return Phase::unload;
    return std::nullopt;
}

/// Phase and cycle from the plate's turns: a phase begins behind the lowest or highest position before a
/// turn.
class Turns {
public:
    explicit Turns(std::vector<Scan>& scans) : scans_(scans) {
        const auto [low, high] = std::ranges::minmax(scans, {}, &Scan::plate_z);
        turn_ = turn_over_stroke * (high.plate_z - low.plate_z);
    }
    void find(bool phases, bool cycles) {
        std::vector<Phase> phase(scans_.size(), Phase::load);
        Phase now = Phase::load;
        std::size_t extreme = 0;
        for (std::size_t i = 1; i < scans_.size(); ++i) {
            const double sign = now == Phase::load ? 1 : -1;
            const double back = sign * (scans_[i].plate_z - scans_[extreme].plate_z);
            if (back <= 0) extreme = i;
            phase[i] = now;
            if (back <= turn_) continue;
            now = now == Phase::load ? Phase::unload : Phase::load;
            std::fill(phase.begin() + static_cast<long>(extreme) + 1,
                      phase.begin() + static_cast<long>(i) + 1, now);
            extreme = i;
        }
        int cycle = 0;
        for (std::size_t i = 0; i < scans_.size(); ++i) {
            if (phases) scans_[i].phase = phase[i];
            if (i > 0 && scans_[i].phase == Phase::load && scans_[i - 1].phase == Phase::unload) ++cycle;
            if (cycles) scans_[i].cycle = cycle;
        }
    }

private:
    std::vector<Scan>& scans_;
    double turn_;  ///< [m]
};

std::optional<Scan> read_scan(const Rows& rows, const RowAt& row, const MappedTable& map,
                              double plate_start) {
    const double length = length_factor(map.word("length_unit", "m")),
                 force = force_factor(map.word("force_unit", "N"));
    const bool goes_down = rows.has_column("displacement");
    const auto z = rows.number(row, goes_down ? "displacement" : "plate_z"),
               top = rows.number(row, "top_force");
    if (!z || !top) return std::nullopt;
    Scan scan = unknown_scan();
    const double origin = number_entry(map, "origin_z") * signed_column(map.word("plate_z", "")).sign;
    scan.plate_z = goes_down ? plate_start - length * *z : length * (*z - origin);
    scan.wall_force[static_cast<std::size_t>(Wall::plate)].z() =
        (map.word("force_sign", "+") == "-" ? -1 : 1) * force * *top;
    if (scan.plate_z <= 0)
        rows.problem_once(
            "plate", row,
            fmt::format("the plate must be over the floor, got a height of {} m: see length_unit{}",
                        scan.plate_z, goes_down ? " and plate.start" : ", plate_z and origin_z"));
    if (rows.has_column("phase")) {
        const auto phase = phase_of(rows.text(row, "phase"));
        if (!phase)
            rows.problem(
                row, fmt::format("phase must be load or unload, got {}", quoted(rows.text(row, "phase"))));
        scan.phase = phase.value_or(Phase::load);
    }
    if (rows.has_column("cycle")) scan.cycle = static_cast<int>(rows.whole_number(row, "cycle").value_or(0));
    return scan;
}

/// A little above the start is noise; further up than down is a wrong sign.
void expect_below(const PlateRows& plate, double start, const Rows& rows) {
    std::size_t highest = 0;
    double low = INFINITY;
    for (std::size_t i = 0; i < plate.scans.size(); ++i) {
        if (plate.scans[i].plate_z > plate.scans[highest].plate_z) highest = i;
        low = std::fmin(low, plate.scans[i].plate_z);
    }
    const double high = plate.scans[highest].plate_z;
    if (high - start > 1e-9 * high && high - start > start - low)
        rows.problem(
            rows.all()[highest],
            fmt::format("the plate must go down from plate.start, {} m, got {} m: {}", start, high,
                        rows.has_column("displacement") ? "displacements count downwards, write a - before "
                                                          "the column's name where it counts upwards"
                                                        : "see length_unit, and --set plate.start=.."));
}

}  // namespace

PlateRows import_plate(const ImportTable& table, double plate_start, ExperimentProblems& problems) {
    PlateRows plate;
    const Rows rows(table, problems);
    plate.keyed = rows.keyed();
    for (const char* key : {"top_force", rows.has_column("displacement") ? "displacement" : "plate_z"})
        if (!rows.has_column(key)) {
            problems.add(table.map.files.front(),
                         fmt::format("must have a column for {}, got none: name it in the mapping", key));
            return plate;
        }
    double before = -INFINITY;
    for (const RowAt& row : rows.all()) {
        const double key = plate.keyed ? row.key : static_cast<double>(plate.keys.size());
        if (!(key > before))
            rows.problem_once("order", row,
                              fmt::format("frame must rise from row to row, got {} after {}", key, before));
        before = key;
        const auto scan = read_scan(rows, row, table.map, plate_start);
        plate.scans.push_back(scan.value_or(unknown_scan()));
        plate.keys.push_back(key);
    }
    plate.index = FrameIndex(plate.keys);
    if (!plate.scans.empty()) expect_below(plate, plate_start, rows);
    int least_cycle = 0;
    if (rows.has_column("cycle") && !plate.scans.empty()) least_cycle = plate.scans.front().cycle;
    for (std::size_t i = 0; i < plate.scans.size(); ++i) {
        Scan& scan = plate.scans[i];
        scan.cycle -= least_cycle;  // many count from 1
        if (i > 0 && scan.cycle < plate.scans[i - 1].cycle)
            rows.problem_once("cycle", rows.all()[i], "cycle must not fall: sort the rows by time");
    }
    if (problems.empty() && !plate.scans.empty())
        Turns(plate.scans).find(!rows.has_column("phase"), !rows.has_column("cycle"));
    return plate;
}

}  // namespace mcdem
