#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiment/measurements.h"
#include "scene/packing_fields.h"

namespace mcdem::inline experiment {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
constexpr int max_frames = 1'000'000;  // as of a scene
constexpr double largest_height =
    20;  // plate height over the width of the box; a larger one is not in metres

}  // namespace

Scan unknown_scan() {
    Scan scan;
    scan.time = not_known;
    scan.kinetic_energy = scan.elastic_energy = not_known;
    scan.coordination_number = scan.mean_force = scan.packing_fraction = scan.branch_length = not_known;
    scan.settled = true;
    for (Vec3& force : scan.wall_force) force.setConstant(not_known);
    return scan;
}

const std::vector<std::string>& plate_columns() {
    static const std::vector<std::string> columns{"frame", "cycle", "phase", "plate_z_m", "top_force_N"};
    return columns;
}

const std::vector<std::string>& plate_columns_of_programmes() {
    static const std::vector<std::string> columns{"set_force_N", "time_s"};
    return columns;
}

namespace {

constexpr std::size_t set_force_column = 5, time_column = 6;

void read_time(Table& table, const std::vector<Scan>& before, Scan& scan) {
    if (!table.has(time_column)) return;
    const auto time = table.number(time_column);
    if (time && !before.empty() && !(*time > before.back().time))
        table.problem(fmt::format("time_s must rise from row to row, got {} after {}: sort the rows by time",
                                  *time, before.back().time));
    scan.time = time.value_or(before.empty() ? 0 : before.back().time);
}

PlateRow row_of(Table& table) {
    PlateRow row{table.line(), {}};
    if (table.has(set_force_column) && !table.text(set_force_column).empty())
        row.set_force = table.number(set_force_column);
    return row;
}

}  // namespace

void read_plate(Table& table, double youngs_modulus, Recording& recording) {
    const double width = std::max(recording.box.size_x, recording.box.size_y);
    const double largest_force = youngs_modulus * recording.box.size_x * recording.box.size_y;
    int cycle_before = 0;
    std::vector<PlateRow> rows;
    for (int row = 0; table.next(); ++row) {
        if (row == max_frames) {
            table.problem(fmt::format("must have at most {} frames", max_frames));
            break;
        }
        Scan scan = unknown_scan();
        scan.frame = row;
        const auto frame = table.whole_number(0, 0), cycle = table.whole_number(1, 0);
        if (frame && *frame != row)
            table.problem(
                fmt::format("frame must be {}, got {}: frames count from 0, one a row, in the order of the "
                            "measurement",
                            row, *frame));
        if (cycle && *cycle < cycle_before)
            table.problem(fmt::format("cycle must not fall, got {} after {}: sort the rows by time", *cycle,
                                      cycle_before));
        cycle_before = scan.cycle = static_cast<int>(cycle.value_or(cycle_before));
        const auto phase = parse<Phase>(table.text(2));
        if (!phase)
            table.problem(
                fmt::format("phase must be one of {}, got {}", all_names<Phase>(), quoted(table.text(2))));
        scan.phase = phase.value_or(Phase::load);
        const auto plate_z = table.number(3), force = table.number(4);
        if (plate_z && *plate_z <= 0)
            table.problem(fmt::format(
                "plate_z_m must be > 0 [m], the height of the plate over the floor, got {}", *plate_z));
        if (plate_z && width > 0 && *plate_z > largest_height * width)
            table.problem_once(
                "unit",
                fmt::format("plate_z_m must be in metres: {} is more than {} times the box's width of {} m; "
                            "divide by 1000 if it is in millimetres",
                            *plate_z, largest_height, width));
        if (force && largest_force > 0 && std::abs(*force) > largest_force)
            table.problem_once(
                "force",
                fmt::format("top_force_N must be in newtons: {} is a pressure beyond Young's modulus, {} "
                            "Pa; divide by 1000 if it is in millinewtons",
                            *force, youngs_modulus));
        scan.plate_z = plate_z.value_or(1);
        scan.wall_force[static_cast<std::size_t>(Wall::plate)].z() = force.value_or(0);
        read_time(table, recording.scans, scan);
        rows.push_back(row_of(table));
        recording.scans.push_back(scan);
    }
    if (table.complete()) check_programme(table, rows, recording);
}

}  // namespace mcdem::experiment
