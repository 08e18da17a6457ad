// Few or ordered grains at rest stay at rest with the default time step: forces on opposite walls balance,
// they are those of a finer step, and motion does not grow, for all contact models, Poisson ratios and
// restitutions.
#include "sim/ordered_packings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/law_range.h"
#include "core/names.h"

namespace mcdem::reference::ordered {
namespace {

using mcdem::IntervalResult;
using mcdem::Wall;

/// At a fifth of the time step a delayed displacement changes by so little that no mode grows at any gain
/// below one.
constexpr double finer = 0.25;
constexpr int settling_steps = 400, free_steps = 1500;
constexpr double settling_drag = 0.2;  ///< share of a velocity that is removed in a step
/// Of the static force. Float resolves an overlap of 0.03 R in a box of 6 R to 1e-5; the kick adds up to
/// 2e-4.
constexpr double allowed_force = 1e-3;
/// Contacts with a restitution of 0.999 or 1 keep the vibrations of the kick: up to 1.7e-3 in rows at small
/// loads.
double allowed_for(double restitution) { return restitution > 0.99 ? 3 * allowed_force : allowed_force; }
/// Kinetic over elastic energy. The kick adds at most 1e-7.
constexpr double allowed_energy = 1e-5;
/// Velocity of each grain after settling, over the velocity of sound: amplitudes are about 1e-6 R.
constexpr double kick = 1e-6;

struct Case {
    Order order;
    ContactModel model;
    double poisson_ratio, overlap, restitution;
    std::string text() const {
        return fmt::format("{}, {}, nu {}, overlap {}, restitution {}", name(order), mcdem::name(model),
                           poisson_ratio, overlap, restitution);
    }
    Start start(double time_step = 1) const {
        Replica replica = ordered_replica(model, poisson_ratio, restitution);
        replica.numerics.time_step *= time_step;
        return ordered_start(replica, order, overlap);
    }
};

/// Overlaps up to 0.20 for models with a tested range, which may stop beyond it, and those of ordinary use
/// for the others. In close-packed cells grains fill the volume at an overlap of 0.095, in a simple cubic one
/// at 0.19.
std::vector<double> overlaps(Order order, ContactModel model) {
    const double most = mcdem::tested_overlap(model) ? 0.20 : 0.05;
    std::vector<double> all{0.03};
    const bool close_packed = order == Order::face_centred || order == Order::hexagonal;
    // Close to the end of static solutions a packing of half spaces relaxes slowly.
    if (close_packed && (model == ContactModel::elastic_half_space || model == ContactModel::mc_dem))
        return all;
    for (double overlap : {0.05, 0.10, 0.15, 0.20})
        if (overlap <= most && overlap <= (close_packed ? 0.10 : order == Order::simple_cubic ? 0.15 : 0.20))
            all.push_back(overlap);
    return all;
}

std::vector<Case> cases(Order order, const std::vector<double>& restitutions) {
    std::vector<Case> all;
    for (ContactModel model : all_models)
        for (double poisson_ratio : {0.3, 0.45, 0.49, 0.5})
            for (double overlap : overlaps(order, model))
                for (double restitution : restitutions)
                    all.push_back({order, model, poisson_ratio, overlap, restitution});
    return all;
}

/// At first short intervals: the engine shortens a time step between intervals, and these grains do not
/// approach slowly.
void settle(Batch& batch, int steps) {
    const double drag = settling_drag / batch.engine().time_step(0);
    for (int i = 0; i < 10; ++i) batch.advance(2, drag);
    batch.advance(steps, drag);
}

void kick_all(Batch& batch, std::size_t replicas) {
    const double velocity = kick * std::sqrt(youngs_modulus / density);
    Uniform uniform(7);
    for (std::size_t r = 0; r < replicas; ++r) {
        const std::size_t grains = batch.start(static_cast<int>(r)).packing.size();
        batch.engine().set_velocities(static_cast<int>(r), uniform.vectors(grains, velocity),
                                      std::vector<Vec3>(grains, Vec3::Zero()));
    }
}

KernelBuild build_for(Order order) {
    return build(mcdem::Precision::single_precision, is_crystal(order) ? 32 : 16);
}

/// After settling and `free_steps` of the default time step, `time_step` times as long.
std::vector<IntervalResult> results(const std::vector<Case>& all, double time_step) {
    std::vector<Start> starts;
    for (const Case& one : all) starts.push_back(one.start(time_step));
    Batch batch(build_for(all.front().order), starts);
    settle(batch, static_cast<int>(settling_steps / time_step));
    kick_all(batch, all.size());
    return batch.advance(static_cast<int>(free_steps / time_step));
}

double normal_force(const IntervalResult& result, Wall wall) {
    const int axis = static_cast<int>(wall) / 2;
    return result.wall_force[static_cast<std::size_t>(wall)][axis];
}

/// What is wrong with the forces; empty if nothing is.
std::string wrong_forces(Order order, const IntervalResult& result, const IntervalResult& reference,
                         double allowed_force) {
    if (is_crystal(order)) {
        const double moved = (result.stress - reference.stress).norm() / reference.stress.norm();
        return moved <= allowed_force ? "" : fmt::format("stress differs by {:.2g}", moved);
    }
    for (const auto& [low, high] : {std::pair(Wall::x_min, Wall::x_max), std::pair(Wall::y_min, Wall::y_max),
                                    std::pair(Wall::floor, Wall::plate)}) {
        const double right = normal_force(reference, high), below = normal_force(result, low),
                     above = normal_force(result, high);
        if (!(std::abs(above + below) <= allowed_force * right))
            return fmt::format("{:.4g} N below, {:.4g} N above", -below, above);
        if (!(std::abs(above - right) <= allowed_force * right))
            return fmt::format("{:.5g} N instead of {:.5g} N", above, right);
    }
    return "";
}

std::string wrong(const Case& one, const IntervalResult& result, const IntervalResult& reference) {
    const bool may_stop = one.overlap > mcdem::tested_overlap(one.model).value_or(1);
    if (result.status) return may_stop ? "" : fmt::format("stopped with status {}", result.status);
    const double part = result.kinetic_energy / result.elastic_energy;
    if (!(part <= allowed_energy)) return fmt::format("kinetic over elastic energy {:.2g}", part);
    return wrong_forces(one.order, result, reference, allowed_for(one.restitution));
}

class OrderedPackings : public testing::TestWithParam<Order> {};

TEST_P(OrderedPackings, StayAtRestWithTheDefaultTimeStep) {
    const std::vector<double> restitutions{0.5, 0.95, 0.999, 1};
    const auto undamped = cases(GetParam(), {1}), all = cases(GetParam(), restitutions);
    const auto expected = results(undamped, finer), found = results(all, 1);
    std::vector<std::string> problems;
    std::size_t compared = 0;
    for (std::size_t k = 0; k < all.size(); ++k) {
        const IntervalResult& reference = expected[k / restitutions.size()];
        if (reference.status) continue;  // no static solution: a half space, or a grain without pores
        ++compared;
        const std::string problem = wrong(all[k], found[k], reference);
        if (!problem.empty()) problems.push_back(all[k].text() + ": " + problem);
    }
    EXPECT_GT(compared, all.size() * 9 / 10);
    EXPECT_TRUE(problems.empty()) << problems.size() << " of " << compared << ":\n"
                                  << fmt::format("{}", fmt::join(problems, "\n"));
}

INSTANTIATE_TEST_SUITE_P(All, OrderedPackings, testing::ValuesIn(all_orders), [](const auto& info) {
    std::string words = name(info.param);
    std::ranges::replace_if(
        words, [](char c) { return c == ' ' || c == '-'; }, '_');
    return words;
});

}  // namespace
}  // namespace mcdem::reference::ordered
