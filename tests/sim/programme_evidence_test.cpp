// Programmes compared with closed-form solutions, and force control with position control.
#include <fmt/core.h>

#include <cmath>

#include "sim/traced_programme.h"

namespace mcdem::reference::programme_evidence {
namespace {

constexpr double radius = 0.01, part = 0.4, relaxation_time = 0.05, hold = 0.15;

/// Each contact is a standard linear solid.
Traced squeezed(const std::string& programme) {
    return trace_one_grain(
        "[effects]\nviscoelasticity = 0.4\nrelaxation_time = 0.05\n[protocol]\nrate_tolerance = 0\n"
        "stop_at_scans = true\n" +
        programme);
}

/// Force of the unrelaxed contact at the plate's position [N].
double hertz(double plate_z) {
    constexpr double youngs_modulus = 23.3e3, poisson = 0.5;
    return 4.0 / 3 * youngs_modulus / (1 - poisson * poisson) * std::sqrt(radius) *
           std::pow(radius - plate_z / 2, 1.5);
}

// F = F_H - a q, dq/dt = (F_H - q) / T: at constant overlap F decays to (1 - a) F_H with the time constant
// T.
TEST(ProgrammeEvidence, RelaxationAgreesWithTheStandardLinearSolid) {
    const Traced traced = squeezed(
        "[[programme]]\nposition = 0.0185\n[[programme]]\nstage = \"hold\"\ntime = 0.15\nscans = 10\n");
    ASSERT_EQ(traced.scans.size(), 11u);
    const double elastic = hertz(0.0185), first = traced.scans[0].force;
    EXPECT_GT(first, 1.1 * (1 - part) * elastic) << "most of it is still to relax";
    double worst = 0;
    for (const auto& scan : traced.scans) {
        const double t = scan.tag.time - traced.scans[0].tag.time;
        const double expected =
            (1 - part) * elastic + (first - (1 - part) * elastic) * std::exp(-t / relaxation_time);
        worst = std::max(worst, std::abs(scan.force / expected - 1));
    }
    EXPECT_LT(worst, 2e-3);
    fmt::print("relaxation against the closed form: {:.2g} % at most\n", 100 * worst);
}

// At constant F, q tends to F / (1 - a) with the time constant T / (1 - a); the overlap follows from F_H = F
// + a q.
TEST(ProgrammeEvidence, CreepAgreesWithTheStandardLinearSolid) {
    const Traced traced = squeezed(
        "[[programme]]\nforce = 0.02\n[[programme]]\nstage = \"hold\"\nkeep = \"force\"\ntime = 0.15\nscans "
        "= 10\n");
    ASSERT_EQ(traced.scans.size(), 11u);
    const double force = 0.02, q_begin = (hertz(traced.scans[0].tag.plate_z) - traced.scans[0].force) / part;
    const double q_end = force / (1 - part);
    const double all = traced.scans[0].tag.plate_z - traced.scans.back().tag.plate_z;
    EXPECT_GT(all, 1e-5) << "there is something to see";
    double worst = 0;
    for (const auto& scan : traced.scans) {
        const double t = scan.tag.time - traced.scans[0].tag.time;
        const double q = q_end + (q_begin - q_end) * std::exp(-t * (1 - part) / relaxation_time);
        worst = std::max(worst, std::abs(hertz(scan.tag.plate_z) / (force + part * q) - 1));
    }
    EXPECT_LT(worst, 3e-3);
    fmt::print("creep of {:.3g} mm against the closed form: {:.2g} % of the elastic force at most\n",
               1e3 * all, 100 * worst);
}

// The positions at which forces were reached are prescribed in a second run.
TEST(ProgrammeEvidence, ForceAndPositionControlAgree) {
    const std::string packing =
        "[box]\nsize_x = 0.08\nsize_y = 0.08\n[grains]\nfriction = 0.3\n[contact]\nfriction_law = "
        "\"mindlin\"\n[packing]\n"
        "count = 60\npacking_fraction = 0.55\n[plate]\nstart = 0.09\nend = 0.05\n[protocol]\nrate_tolerance "
        "= 0.01\n";
    double sum = 0, squares = 0;
    int count = 0;
    for (int seed = 1; seed <= 6; ++seed) {
        const std::vector<std::string> overrides{fmt::format("packing.seed={}", seed)};
        const Traced by_force =
            trace(packing + "[[programme]]\nforce = 1.5\nscan_at = [0.5, 1, 1.5]\n", overrides);
        ASSERT_EQ(by_force.scans.size(), 3u);
        std::string places;
        for (const auto& scan : by_force.scans)
            places += fmt::format("{}{}", places.empty() ? "" : ", ", scan.tag.plate_z);
        const Traced by_position =
            trace(packing + fmt::format("[[programme]]\nposition = {}\nscan_at = [{}]\n",
                                        by_force.scans[2].tag.plate_z, places),
                  overrides);
        ASSERT_EQ(by_position.scans.size(), 3u);
        for (int k = 0; k < 3; ++k) {
            const double ratio = by_force.scans[k].force / by_position.scans[k].force;
            sum += ratio;
            squares += ratio * ratio;
            ++count;
        }
    }
    const double mean = sum / count, error = std::sqrt((squares / count - mean * mean) / (count - 1));
    fmt::print("force over position control at the same place: {:.4f} +- {:.4f}\n", mean, error);
    EXPECT_NEAR(mean, 1, 3 * error + 1e-3);
    EXPECT_LT(error, 0.01);
}

}  // namespace
}  // namespace mcdem::reference::programme_evidence
