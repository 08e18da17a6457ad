#include "sim/failure_causes.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/container.h"
#include "core/law_range.h"
#include "scene/packing/neighbour_slots.h"

namespace mcdem::inline sim {
namespace {

/// At rest the net force on a grain is below protocol.settle_unbalanced_force of the pressure, and the sum
/// over all grains is much smaller than that times their number.
constexpr double max_imbalance = 0.05;

std::string compress_less(const Replica& replica) {
    return is_cell(replica.box) ? "compress less" : "compress less: raise plate.end";
}

/// Why an overlap passed its limit, and what to do. `relaxes`: before the plate or the cell has moved.
std::string cause_of_overlap(const Replica& replica, bool relaxes) {
    const auto passed = fmt::format(
        "a corrected overlap passed numerics.overlap_limit = {} of the sum of the radii (of unequal "
        "grains times the ratio of the radii)",
        replica.numerics.overlap_limit);
    const bool has_gamma = replica.contact.model == ContactModel::mc_dem;
    if (relaxes)
        return fmt::format(
            "{} while the packing relaxed, before the {} moved: {}the packing is too dense{}, or the time "
            "step "
            "is too long (numerics.time_step)",
            passed, is_cell(replica.box) ? "cell" : "plate",
            is_cell(replica.box) ? "" : "the grains are too soft for their weight (youngs_modulus in Pa?), ",
            has_gamma ? ", contact.gamma is too high" : "");
    if (replica.contact.model == ContactModel::hyperelastic_sphere)
        return fmt::format("{} ({}; or raise numerics.overlap_limit, there are solutions beyond)", passed,
                           compress_less(replica));
    return fmt::format("{}: no static solution at this compression, the force runs away ({}{})", passed,
                       compress_less(replica), has_gamma ? ", or lower contact.gamma" : "");
}

std::string cause_of_slots(int slots) {
    const auto many = fmt::format("a grain has more than {} near neighbours", slots);
    if (slots < most_slots)
        return fmt::format("{} (set numerics.slots = {}, or lower numerics.skin)", many, slots + 16);
    return fmt::format("{}, the most that there can be: {} (lower numerics.skin)", many, widest_sizes);
}

}  // namespace

std::string cause_of(const IntervalResult& result, const Replica& replica, int slots, bool relaxes) {
    std::string cause;
    const auto add = [&](int bit, const std::string& text) {
        if (result.status & bit) cause += (cause.empty() ? "" : "; ") + text;
    };
    add(STATUS_OVERLAP, cause_of_overlap(replica, relaxes));
    add(STATUS_NOT_A_NUMBER,
        "a position is not a number: the time step is too long (lower numerics.time_step)");
    add(STATUS_LOST,
        is_cell(replica.box)
            ? "a grain has moved on by more than 8 cells, beyond the cell's own motion: too long a time step "
              "(lower numerics.time_step)"
        : is_periodic(replica.box)
            ? "a grain has left between floor and plate, or moved on by more than 8 cells: too fast a plate "
              "or too "
              "long a time step (lower plate.speed or numerics.time_step)"
            : "the centre of a grain left the container: too fast a plate or too long a time step (lower "
              "plate.speed or numerics.time_step)");
    add(STATUS_SLOTS, cause_of_slots(slots));
    add(STATUS_UNPROBED,
        fmt::format("a free surface moved out by more than numerics.probe_gap = {} mean radii: "
                    "contacts could be missed (raise numerics.probe_gap)",
                    replica.numerics.probe_gap));
    return cause;
}

std::string beyond_law(const Replica& replica, const Scan& scan) {
    const auto tested = tested_overlap(replica.contact.model);
    if (!replica.numerics.stop_beyond_law || !tested || !(scan.max_overlap > *tested)) return "";
    return fmt::format(
        "grains overlap by {:.3f} of the sum of their radii (of unequal grains times the ratio of the "
        "radii), "
        "more than the law of {} was tested for, {} "
        "({}; or set numerics.stop_beyond_law = false)",
        scan.max_overlap, name(replica.contact.model), *tested, compress_less(replica));
}

std::string created_energy(const EnergyBudget& budget) {
    if (budget.verdict() != EnergyBudget::Verdict::too_much_created) return "";
    return fmt::format(
        "the time step has created energy, {:.1f} % of the largest stored energy: the dissipated energy "
        "falls "
        "(lower numerics.time_step or compress less; or set numerics.precision = \"double\" if overlaps are "
        "below 1e-4 of a diameter)",
        100 * budget.created());
}

std::string imbalance(const IntervalResult& result, double weight) {
    Vec3 net(0, 0, weight);
    double largest = 0;
    for (const Vec3& force : result.wall_force) {
        net += force;
        largest = std::max(largest, force.norm());
    }
    if (net.norm() <= max_imbalance * largest) return "";
    return fmt::format(
        "the grains are at rest, but the forces on walls and the weight do not balance: {:.3g} N are left of "
        "{:.3g} N (lower numerics.time_step)",
        net.norm(), largest);
}

}  // namespace mcdem::sim
