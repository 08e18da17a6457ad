#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parameters.h"
#include "experiment/measurements.h"
#include "scene/packing/packing_fields.h"
#include "scene/programme/programme_text.h"

namespace mcdem::inline experiment {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
constexpr int max_frames = 1'000'000;  // as of a scene
constexpr double largest_height =
    20;  // plate height over the width of the box; a larger one is not in metres

constexpr std::size_t set_force_column = 5, time_column = 6;

void read_time(Table& table, const std::vector<Scan>& before, Scan& scan) {
    if (!table.has(time_column)) return;
    const auto time = table.number(time_column);
    if (time && !before.empty() && !(*time > before.back().time))
        table.problem(fmt::format("time_s must rise from row to row, got {} after {}: sort the rows by time",
                                  *time, before.back().time));
    scan.time = time.value_or(before.empty() ? 0 : before.back().time);
}

/// A row of plate.csv: its place and its prescribed force.
struct PlateRow {
    long line = 0;
    std::optional<double> set_force;  ///< [N]
};
PlateRow row_of(Table& table) {
    PlateRow row{table.line(), {}};
    if (table.has(set_force_column) && !table.text(set_force_column).empty())
        row.set_force = table.number(set_force_column);
    return row;
}

/// Rows with larger deviations belong to other scans; relative to the stroke, the force and the duration of
/// the hold.
constexpr double far_position = 0.25, far_force = 0.5, far_time = 0.1;
constexpr double other_force = 0.01;  // relative to the prescribed force

struct Programme {
    std::vector<Stage> stages;
    std::vector<ScanPlace> places;
};
Programme programme_in(const Recording& recording) {
    Programme programme{programme_of(recording.parameters), {}};
    programme.places = scan_places(programme.stages, {recording.plate_start, 0});
    return programme;
}

/// Checks the rows of plate.csv against the scans of a programme.
class Rows {
public:
    Rows(Table& table, const std::vector<PlateRow>& rows, const Recording& recording)
        : table_(table), rows_(rows), recording_(recording), programme_(programme_in(recording)) {
        for (const Scan& scan : recording.scans) stroke_ = std::max(stroke_, recording.displacement(scan));
    }

    void check() {
        if (rows_.size() != programme_.places.size() + 1)
            return table_.problem_at(
                table_.name(),
                fmt::format("must have {} rows, one of the packing at rest and one for each of the {} scans "
                            "of [[programme]] in experiment.toml, got {}: state the scans of its stages as "
                            "they were measured (scans, scan_at)",
                            programme_.places.size() + 1, programme_.places.size(), rows_.size()));
        for (std::size_t k = 0; k < programme_.places.size(); ++k) {
            const ScanPlace& place = programme_.places[k];
            if (place.by == Controlled::force)
                check_force(k + 1, place);
            else
                check_position(k + 1, place);
            if (place.held && k > 0 && programme_.places[k - 1].leg == place.leg) check_time(k + 1, place);
        }
    }

private:
    void problem(std::size_t row, const std::string& what) {
        table_.problem_at(table_.where(rows_[row].line), what);
    }
    static std::string stage_words(const ScanPlace& place) {
        return fmt::format("stage {} of [[programme]] in experiment.toml", place.stage + 1);
    }

    void check_position(std::size_t row, const ScanPlace& place) {
        const double z = recording_.scans[row].plate_z;
        if (rows_[row].set_force)
            problem(row, fmt::format("set_force_N must be empty, got {}: {} sets a position",
                                     *rows_[row].set_force, stage_words(place)));
        if (std::abs(z - place.set) > far_position * stroke_)
            problem(row, fmt::format("plate_z_m must be near {:.6g} m, which {} sets, got {}: state the "
                                     "stages in their order, with their scans",
                                     place.set, stage_words(place), z));
    }

    void check_force(std::size_t row, const ScanPlace& place) {
        const double top = recording_.scans[row].top_force(), set = rows_[row].set_force.value_or(place.set);
        if (std::abs(set - place.set) > other_force * place.set)
            problem(row, fmt::format("set_force_N must be {:.6g} N, which {} sets, got {}: state the stages "
                                     "in their order, with their scans",
                                     place.set, stage_words(place), set));
        else if (std::abs(top - set) > far_force * set)
            problem(row, fmt::format("top_force_N must be near {:.6g} N, which {} sets, got {}: state the "
                                     "stages in their order, with their scans",
                                     set, stage_words(place), top));
    }

    void check_time(std::size_t row, const ScanPlace& place) {
        const double time = recording_.scans[row].time - recording_.scans[row - 1].time;
        const double set = place.time - programme_.places[row - 2].time;
        const double whole = programme_.stages[place.stage].time;
        if (std::abs(time - set) > far_time * whole)
            problem(row, fmt::format("time_s must be {:.6g} s after the row before, as {} holds, got {:.6g} "
                                     "s: state when the hold was scanned (time, scans, scan_at)",
                                     set, stage_words(place), time));
    }

    Table& table_;
    const std::vector<PlateRow>& rows_;
    const Recording& recording_;
    Programme programme_;
    double stroke_ = 0;  ///< [m]
};

/// Reports rows that do not match the scans of the recording's programme.
void check_programme(Table& table, const std::vector<PlateRow>& rows, const Recording& recording) {
    if (!has_programme(recording.parameters)) return;
    if (std::isnan(recording.scans.front().time))
        return table.problem_at(table.where(1),
                                "the header must name time_s where experiment.toml states a [[programme]]: "
                                "when each row was measured [s]");
    Rows(table, rows, recording).check();
}

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

std::vector<std::optional<double>> set_forces(const Recording& recording) {
    std::vector<std::optional<double>> forces(recording.scans.size());
    const Programme programme = programme_in(recording);
    double before = not_given;  // force kept by a hold that does not set one
    for (std::size_t k = 0; k < programme.places.size() && k + 1 < forces.size(); ++k) {
        const ScanPlace& place = programme.places[k];
        const bool begins = k == 0 || programme.places[k - 1].leg != place.leg;
        if (begins) before = recording.scans[k].top_force();
        if (place.by != Controlled::force) continue;
        if (!std::isnan(place.set) || place.held) forces[k + 1] = std::isnan(place.set) ? before : place.set;
    }
    return forces;
}

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
                fmt::format(
                    "top_force_N must be in newtons: {} is a pressure beyond Young's modulus, {} "
                    "Pa; divide by 1000 if it is in millinewtons, or correct grains.youngs_modulus if "
                    "it is not in Pa",
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
