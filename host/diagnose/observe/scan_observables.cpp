#include "diagnose/observe/scan_observables.h"

#include <array>
#include <cmath>

#include "diagnose/observe/force_statistics.h"
#include "diagnose/observe/overlap_regression.h"

namespace mcdem::inline diagnose {
namespace {

// clang-format off
constexpr Observable all_observables[] = {
    {"top_force", Needs::plate, 0.003, "plate", "", "log of the force on the plate"},

    {"floor_force", Needs::contacts, 0.003, "floor", "", "force on the floor over that on the plate"},
    {"side_force", Needs::contacts, 0.003, "sides", "", "a quarter of the normal forces on the sides over the force on the plate"},
    {"plate_contacts", Needs::contacts, 0.003, "plate", "", "sum of the contact forces at the plate over the plate's own reading"},
    {"plate_couple_x", Needs::contacts, 0.002, "plate", "", "centre of the plate's load along x, over half the box"},
    {"plate_couple_y", Needs::contacts, 0.002, "plate", "", "centre of the plate's load along y, over half the box"},
    {"coordination_number", Needs::contacts, 0.01, "", "", "contacts per grain"},
    {"weak_contacts", Needs::contacts, 0.005, "", "weak", "contacts per grain with one to two times the force threshold"},
    {"mean_force", Needs::contacts, 0.003, "", "", "log of the mean contact force"},
    {"force_spread", Needs::contacts, 0.005, "", "", "standard deviation of contact forces over their mean"},
    {"weak_forces", Needs::contacts, 0.003, "", "weak", "fraction of the contacts below 0.3 mean forces"},
    {"strong_forces", Needs::contacts, 0.003, "", "strong", "fraction of the contacts above 2 mean forces"},
    {"strongest_forces", Needs::contacts, 0.01, "", "strong", "95 % quantile of contact forces over their mean"},

    {"section_load", Needs::positions, 0.002, "", "", "vertical force through horizontal sections, what the side walls carry above them added, over the plate's reading"},
    {"force_anisotropy", Needs::positions, 0.001, "", "", "vertical share of normal forces, minus one third"},
    {"vertical_gradient", Needs::positions, 0.01, "", "", "change of the mean contact force with depth, over the height"},
    {"non_affine", Needs::positions, 0.001, "", "", "non-affine displacement since the first scan, over the mean diameter"},
    {"attraction", Needs::positions, 0.001, "", "weak", "fraction of the contacts that pull"},
    {"friction_ratio", Needs::positions, 0.0003, "grains", "", "mean ratio of tangential to normal force between grains"},
    {"friction_high", Needs::positions, 0.0003, "grains", "", "80 % quantile of this ratio between grains"},
    {"friction_sliding", Needs::positions, 0.01, "grains", "", "fraction of the contacts between grains where this ratio is within 20 % of the stated friction"},
    {"wall_friction_ratio", Needs::positions, 0.0003, "walls", "", "mean ratio of tangential to normal force at walls"},
    {"wall_friction_high", Needs::positions, 0.0003, "walls", "", "80 % quantile of this ratio at walls"},
    {"torque_imbalance", Needs::positions, 0.002, "grains", "", "sum over grains of the net torque of the contacts, over the sum of the contacts' torques"},
    {"gap_contacts", Needs::positions, 0.005, "grains", "weak", "contacts per grain between spheres that do not overlap"},
    {"silent_overlaps", Needs::positions, 0.005, "grains", "weak", "overlapping pairs without a listed contact, per grain"},
    {"overlap_offset", Needs::positions, 0.0005, "grains", "", "implied minus measured overlap of grains, at zero force"},
    {"overlap_slope", Needs::positions, 0.003, "grains", "", "change of implied minus measured overlap of grains with the implied overlap"},
    {"overlap_curvature", Needs::positions, 0.02, "grains", "strong", "change of implied minus measured overlap of grains with the square of the implied overlap"},
    {"cross_contact", Needs::positions, 0.005, "grains", "", "change of implied minus measured overlap of grains with the surface displacement by the other contacts"},
    {"overlap_scatter", Needs::positions, 0.0003, "grains", "", "standard deviation over contacts of the residuals of this regression"},
    {"grain_scatter", Needs::positions, 0.0005, "grains", "", "standard deviation over grains of their mean residual"},
    {"grain_scatter_slope", Needs::positions, 0.0005, "grains", "", "standard deviation over grains of the slope of their residuals with the overlap"},
    {"side_overlap_offset", Needs::positions, 0.0005, "sides", "", "implied minus measured overlap at the side walls, at zero force"},
    {"side_overlap_slope", Needs::positions, 0.003, "sides", "", "change of implied minus measured overlap at the side walls with the implied overlap"},
    {"floor_overlap_offset", Needs::positions, 0.0005, "floor", "", "implied minus measured overlap at the floor, mean"},
    {"plate_overlap_offset", Needs::positions, 0.0005, "plate", "", "implied minus measured overlap at the plate, mean"},
    {"plate_overlap_tilt_x", Needs::positions, 0.0005, "plate", "", "slope along x of implied minus measured overlap at the plate, in R over half the box"},
    {"plate_overlap_tilt_y", Needs::positions, 0.0005, "plate", "", "slope along y of implied minus measured overlap at the plate, in R over half the box"},

    {"displacement", Needs::programme, 0.002, "plate", "", "displacement of the plate over the stroke, where the force on it is set"},
    {"relaxation", Needs::programme, 0.003, "plate", "", "log of the force on the plate at the beginning of a hold of its position, minus that at the end"},
    {"creep", Needs::programme, 0.002, "plate", "", "downward displacement of the plate during a hold of its force, over the stroke"},
};
// clang-format on
constexpr std::size_t count = std::size(all_observables);

/// Collects groups of numbers in the order of the table.
class Row {
public:
    template <std::size_t n>
    void add(const std::array<double, n>& values) {
        for (const double value : values) row_[next_++] = value;
    }
    const Eigen::VectorXd& done() const { return row_; }

private:
    Eigen::VectorXd row_ = Eigen::VectorXd::Constant(count, unknown);
    Eigen::Index next_ = 0;
};

}  // namespace

std::span<const Observable> observables() { return all_observables; }

Eigen::Index index_of(OfProgramme observable) {
    constexpr Eigen::Index of_programmes = 3;
    return static_cast<Eigen::Index>(count) - of_programmes + static_cast<Eigen::Index>(observable);
}

Eigen::VectorXd scan_observables(const Recording& recording, const Scan& scan,
                                 const ReferenceMaterial& material) {
    Row row;
    const double top = scan.top_force();
    row.add(std::array{top > 0 ? std::log(top) : unknown});
    if (scan.contacts.size() < min_contacts) return row.done();
    row.add(wall_loads(recording, scan));
    row.add(force_distribution_numbers(recording, scan, material));
    if (scan.position.empty()) return row.done();
    const auto residuals = contact_residuals(recording, scan, material);
    row.add(std::array{section_load(scan)});
    row.add(fabric(recording, scan, residuals));
    row.add(friction_numbers(recording, scan, residuals, material));
    row.add(contact_occurrence(recording, scan, residuals));
    row.add(grain_overlaps(recording, residuals));
    row.add(wall_overlaps(recording, scan, residuals));
    return row.done();
}

}  // namespace mcdem::diagnose
