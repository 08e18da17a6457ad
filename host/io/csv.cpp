#include "io/csv.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "core/container.h"
#include "core/csv_text.h"
#include "core/errors.h"
#include "core/output_file.h"
#include "io/results.h"

namespace mcdem::inline io {
namespace {

constexpr const char* header =
    "replica,label,frame,cycle,phase,time_s,plate_z_m,displacement_m,top_force_N,floor_force_N,"
    "x_min_force_N,x_max_force_N,y_min_force_N,y_max_force_N,coordination_number,mean_force_N,"
    "packing_fraction,branch_length_m,max_overlap,stress_xx_Pa,stress_yy_Pa,stress_zz_Pa,stress_yz_Pa,stress_"
    "xz_Pa,"
    "stress_xy_Pa,kinetic_energy_J,elastic_energy_J,settled,rate_error,wall_work_J,weight_work_J,damping_"
    "loss_J,"
    "friction_loss_J,drag_loss_J,energy_error_J";

constexpr std::pair<int, int> voigt[] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};

/// Numbers are not changed, words are quoted.
std::string csv_value(const Parameter& value) {
    const std::string text = parameter_text(value);
    return is_number(text) || text.empty() ? text : csv_cell(without_quotes(text));
}

/// The force that presses a flat wall, or a face of a cell, outwards; NaN for a wall that is missing or not
/// flat [N].
double pressing(const Box& box, const Scan& scan, Wall wall) {
    if ((!has_wall(box, wall) && !is_cell(box)) || (is_cylinder(box) && wall == curved_wall))
        return std::numeric_limits<double>::quiet_NaN();
    const int n = static_cast<int>(wall);  // two walls for each axis, the lower one first
    const double force = scan.wall_force[n][n / 2];
    return n % 2 ? force : -force;
}

/// The vertical force on a cylinder's wall; NaN in other containers [N].
double along_side(const Box& box, const Scan& scan) {
    if (!is_cylinder(box)) return std::numeric_limits<double>::quiet_NaN();
    return scan.wall_force[static_cast<std::size_t>(curved_wall)].z();
}

}  // namespace

std::string csv_text(const Run& run, const StopWanted& stop_wanted) {
    fmt::memory_buffer text;
    auto out = std::back_inserter(text);
    std::vector<Parameters> parameters_of_all;
    for (const Recording& recording : run.recordings) parameters_of_all.push_back(recording.parameters);
    const auto keys = keys_that_vary(parameters_of_all);
    fmt::format_to(out, header);
    const bool any_side = std::ranges::any_of(
        run.recordings, [](const Recording& recording) { return is_cylinder(recording.box); });
    if (any_side) fmt::format_to(out, ",side_force_z_N");
    const bool any_cell = std::ranges::any_of(
        run.recordings, [](const Recording& recording) { return is_cell(recording.box); });
    if (any_cell) fmt::format_to(out, ",strain_x,strain_y,strain_z,shear_xy,shear_xz,shear_yz");
    for (const auto& key : keys) fmt::format_to(out, ",{}", key);
    fmt::format_to(out, "\n");
    for (std::size_t r = 0; r < run.recordings.size(); ++r) {
        if (stop_wanted()) throw Interrupted();
        const Recording& recording = run.recordings[r];
        const std::string label = csv_cell(recording.label);
        std::string parameters;
        for (const auto& key : keys)
            parameters.append(",").append(csv_value(find_parameter(recording.parameters, key)));
        for (const Scan& scan : recording.scans) {
            // "{}" prints the shortest digits that give the same number when read.
            fmt::format_to(out, "{},{},{},{},{},{},{},{},", r, label, scan.frame, scan.cycle,
                           name(scan.phase), scan.time, scan.plate_z, recording.displacement(scan));
            for (Wall wall : {Wall::plate, Wall::floor, Wall::x_min, Wall::x_max, Wall::y_min, Wall::y_max})
                fmt::format_to(out, "{},", pressing(recording.box, scan, wall));
            fmt::format_to(out, "{},{},{},{},{},", scan.coordination_number, scan.mean_force,
                           scan.packing_fraction, scan.branch_length, scan.max_overlap);
            for (const auto& [row, column] : voigt)
                fmt::format_to(out, "{},", 0.5 * (scan.stress(row, column) + scan.stress(column, row)));
            fmt::format_to(out, "{},{},{:d},{},", scan.kinetic_energy, scan.elastic_energy, scan.settled,
                           scan.rate_error);
            fmt::format_to(out, "{},{},{},{},{},{}", scan.wall_work, scan.weight_work, scan.damping_loss,
                           scan.friction_loss, scan.drag_loss, scan.energy_error);
            if (any_side) fmt::format_to(out, ",{}", along_side(recording.box, scan));
            if (any_cell) fmt::format_to(out, ",{}", fmt::join(scan.strain, ","));
            fmt::format_to(out, "{}\n", parameters);
        }
    }
    return fmt::to_string(text);
}

void write_csv(const std::filesystem::path& folder, const StopWanted& stop_wanted) {
    const Run run = read_run(folder, ReadWhat::observables, stop_wanted);
    replace_table(folder / "plate.csv", csv_text(run, stop_wanted));
}

}  // namespace mcdem::io
