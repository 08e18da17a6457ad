// Few or ordered grains that are compressed from the first contact on, with the default time step and speed:
// forces balance and are those of a quarter of the time step, and little of the energy is kinetic.
#include <fmt/format.h>

#include <cmath>

#include "core/law_range.h"
#include "core/names.h"
#include "sim/ordered_packings.h"
#include "sim/simulated.h"

namespace mcdem::reference::ordered_strokes {
namespace {

using namespace ordered;
using mcdem::Scan;
using mcdem::Wall;

constexpr int scans = 10;
/// Of the force, as protocol.rate_tolerance: the moving plate leaves the forces above and below unequal by
/// less than that.
constexpr double allowed_force = 0.02;
/// Kinetic over elastic energy, from an overlap of 0.02 on. With growing modes it was 1e-2 to 1.
constexpr double allowed_energy = 1e-3;
constexpr double least_overlap = 0.02;

struct Case {
    Order order;
    ContactModel model;
    double poisson_ratio, restitution;
    /// In close-packed cells grains fill the volume at 0.095. There and with six plates their pressure limits
    /// the models.
    double most() const { return std::min(*mcdem::tested_overlap(model), is_crystal(order) ? 0.08 : 0.20); }
    std::string text() const {
        return fmt::format("{}, {}, nu {}, restitution {}", name(order), mcdem::name(model), poisson_ratio,
                           restitution);
    }
    Start start(double time_step) const {
        Start start = ordered_start(ordered_replica(model, poisson_ratio, restitution), order, most());
        if (is_crystal(order)) {
            start = ordered_start(start.replica, order, 0);
            mcdem::Stage compression;
            compression.strain = most();
            compression.scans = scans;
            start.replica.programme = {compression};
        } else {
            start.replica.plate.end = start.replica.plate.start;
            start.replica.plate.start /= 1 - most();
            for (std::size_t i = 0; i < start.packing.size(); ++i)
                start.packing.position[i].z() = radius * (1 + 2 * static_cast<double>(i));
        }
        start.replica.numerics.time_step *= time_step;
        start.replica.protocol.scans_per_stroke = scans;
        start.replica.protocol.relax_time = 0.01;
        start.replica.protocol.rate_tolerance = allowed_force;
        return start;
    }
};

std::vector<Case> cases() {
    std::vector<Case> all;
    for (Order order : {Order::two_plates, Order::row_of_three, Order::face_centred, Order::hexagonal})
        for (ContactModel model : {ContactModel::elastic_sphere, ContactModel::hyperelastic_sphere})
            for (double poisson_ratio : {0.3, 0.49})
                for (double restitution : {0.95, 0.999})
                    all.push_back({order, model, poisson_ratio, restitution});
    return all;
}

Simulated strokes(const std::vector<Case>& all, double time_step) {
    mcdem::Scene scene;
    scene.slots = 32;
    scene.output.positions = scene.output.contacts = false;
    std::vector<Packing> packings;
    for (const Case& one : all) {
        const Start start = one.start(time_step);
        scene.replicas.push_back(start.replica);
        packings.push_back(start.packing);
    }
    return simulated(scene, packings, false, scans);
}

double force(const Scan& scan, Wall wall) {
    return std::abs(scan.wall_force[static_cast<std::size_t>(wall)].z());
}

/// What is wrong in a scan; empty if nothing is.
std::string wrong(const Scan& scan, const Scan& finer) {
    const double above = force(scan, Wall::plate), below = force(scan, Wall::floor),
                 right = force(finer, Wall::plate), part = scan.kinetic_energy / scan.elastic_energy;
    if (!(part <= allowed_energy)) return fmt::format("kinetic over elastic energy {:.2g}", part);
    if (!(std::abs(above - below) <= allowed_force * right))
        return fmt::format("{:.4g} N below, {:.4g} N above", below, above);
    if (!(std::abs(above - right) <= allowed_force * right))
        return fmt::format("{:.4g} N instead of {:.4g} N", above, right);
    return "";
}

TEST(OrderedStrokes, HaveTheForcesOfAFinerStep) {
    const auto all = cases();
    const auto found = strokes(all, 1), finer = strokes(all, 0.25);
    for (std::size_t k = 0; k < all.size(); ++k) {
        SCOPED_TRACE(all[k].text());
        ASSERT_GE(finer.scans[k].size(), std::size_t{scans});
        ASSERT_GE(found.scans[k].size(), std::size_t{scans});
        for (std::size_t i = 0; i < std::size_t{scans}; ++i) {
            const double overlap = all[k].most() * static_cast<double>(i + 1) / scans;
            if (overlap < least_overlap) continue;
            const std::string problem = wrong(found.scans[k][i], finer.scans[k][i]);
            EXPECT_EQ(problem, "") << "overlap " << overlap;
            if (!problem.empty()) break;
        }
    }
}

}  // namespace
}  // namespace mcdem::reference::ordered_strokes
