// Random programmes on a cell that is represented by a spring: they end, and scans have the prescribed
// strains and stresses.
#include <algorithm>
#include <cmath>

#include "sim/driven_protocol.h"
#include "sim/random_draws.h"

namespace mcdem::random_cell_programmes {
namespace {

constexpr double time_step = 1e-4, size = 0.09;
const PackingScale scale{.diameter = 0.02,
                         .count = 100,
                         .volume = 4.2e-4,
                         .mass = 4.8e-3,
                         .density = 11.5,
                         .modulus = 31e3,
                         .reach = 0.028};

/// Elastic and without inertia; the normal directions are coupled, shear changes all normal stresses, and the
/// pressure the stiffness against shear.
Mat3 spring_stress(const Strain& strain) {
    Mat3 stress = Mat3::Zero();
    const double all = strain[0] + strain[1] + strain[2],
                 shear = strain[3] * strain[3] + strain[4] * strain[4];
    for (int axis = 0; axis < 3; ++axis)
        stress(axis, axis) =
            6e3 * std::pow(std::max(0.0, 0.6 * strain[axis] + 0.4 * all / 3 + shear - 0.02), 1.5);
    const double stiffness = 100 + 2 * stress.trace() / 3;
    stress(0, 1) = stress(1, 0) = -stiffness * strain[3];
    stress(0, 2) = stress(2, 0) = -stiffness * strain[4];
    stress(1, 2) = stress(2, 1) = -stiffness * strain[5];
    return stress;
}

void respond(const IntervalEnd& end, IntervalResult& result) { result.stress = spring_stress(end.strain); }

class RandomProgramme : RandomDraws {
public:
    using RandomDraws::RandomDraws;

    std::vector<Stage> draw() {
        std::vector<Stage> stages;
        for (int n = whole(1, 6); n > 0; --n) stages.push_back(stage(static_cast<int>(stages.size())));
        return stages;
    }

private:
    Stage stage(int number) {
        Stage stage;
        stage.kind = number == 0 ? StageKind::move
                                 : std::array{StageKind::move, StageKind::hold,
                                              StageKind::repeat}[static_cast<std::size_t>(whole(0, 2))];
        stage.scans = whole(0, 3);
        stage.rate = between(0.1, 1);
        if (stage.kind == StageKind::repeat) stage.stages = 1;
        if (stage.kind == StageKind::hold) {
            stage.time = between(0.01, 0.3);
            stage.keep = under_stress_ && whole(0, 1) ? Controlled::stress : Controlled::position;
        }
        if (stage.kind != StageKind::move) return stage;
        if (whole(0, 2) == 0) stage.pressure = between(50, 400);
        double* const strains[]{&stage.strain_x, &stage.strain_y, &stage.strain_z};
        double* const stresses[]{&stage.stress_x, &stage.stress_y, &stage.stress_z};
        for (int axis = 0; std::isnan(stage.pressure) && axis < 3; ++axis)
            if (whole(0, 1))
                *stresses[axis] = between(100, 400);
            else
                *strains[axis] = between(0.05, 0.2);
        if (whole(0, 1)) (whole(0, 1) ? stage.shear_xz : stage.shear_xy) = between(-0.1, 0.1);
        if (whole(0, 1)) stage.stress_yz = between(-20, 20);
        if (std::isnan(stage.shear_xz) && whole(0, 1)) stage.stress_xz = between(-20, 20);
        under_stress_ = sets_stress(stage);
        return stage;
    }
    bool under_stress_ = false;
};

/// The last scan of a leg, at rest: prescribed values are reached, and strains that the stage does not name
/// are unchanged.
void expect_end(const Stage& stage, const Strain& begin, const Strain& after) {
    const SetStress set = set_stress(stage);
    const Strain wanted = strain_after(stage, begin);
    const Mat3 stress = spring_stress(after);
    const double pressure = stress.trace() / 3, shears[]{stress(0, 1), stress(0, 2), stress(1, 2)};
    for (std::size_t k = 0; k < 6; ++k) {
        if (k < 3 && !std::isnan(set[k]))
            EXPECT_NEAR(stress(static_cast<int>(k), static_cast<int>(k)) / set[k], 1, 1e-3);
        else if (!std::isnan(set[k]))
            EXPECT_NEAR(shears[k - 3], set[k], 1e-3 * std::max(std::abs(set[k]), pressure / 10)) << k;
        else
            EXPECT_NEAR(after[k], wanted[k], 1e-12) << k;
    }
}

TEST(RandomCellProgrammes, EndAndScanAtThePrescribedValues) {
    int by_stress = 0, ends = 0;
    for (unsigned seed = 1; seed <= 60; ++seed) {
        SCOPED_TRACE(seed);
        Replica replica;
        replica.box = {size, size, ContainerShape::cell, size};
        replica.plate = {size, 0, 0.1};
        replica.programme = RandomProgramme(seed).draw();
        replica.protocol.stop_at_scans = seed % 3 > 0;
        replica.protocol.rate_tolerance = seed % 2 ? 0 : 0.01;
        ProtocolRunner runner(replica, time_step, scale);
        const auto legs = legs_of(replica.programme, replica.plate);
        Strain begin{};
        int scans = 0, leg = 0, level = 0;
        const auto watch = [&](const auto& before, const auto& interval, const auto& end, const auto& scan) {
            for (int axis = 0; axis < 3; ++axis) ASSERT_LE(end.strain[axis], 0.378);
            if (before.leg != leg) {
                leg = before.leg;
                level = 0;
                begin = interval.strain;
            }
            if (!scan) return;
            ++scans;
            const Stage& stage =
                replica.programme[static_cast<std::size_t>(legs[static_cast<std::size_t>(leg)].stage)];
            if (++level < stage.scans || stage.kind != StageKind::move || !replica.protocol.stop_at_scans)
                return;
            expect_end(stage, begin, end.strain);
            by_stress += sets_stress(stage);
            ++ends;
        };
        drive(runner, time_step, 60, respond, watch);
        ASSERT_EQ(runner.hindrance(), "");
        EXPECT_EQ(scans, scan_count(replica.programme));
        EXPECT_EQ(runner.progress(), 1);
    }
    EXPECT_GT(by_stress, 30);
    EXPECT_GT(ends, by_stress);
}

ProtocolRunner runner_of(const std::vector<Stage>& programme, bool stop_at_scans = true,
                         double rate_tolerance = 0) {
    Replica replica;
    replica.box = {size, size, ContainerShape::cell, size};
    replica.plate = {size, 0, 0.1};
    replica.programme = programme;
    replica.protocol.stop_at_scans = stop_at_scans;
    replica.protocol.rate_tolerance = rate_tolerance;
    for (Stage& stage : replica.programme) stage.rate = 1;
    return ProtocolRunner(replica, time_step, scale);
}

/// A cell with one move to a pressure of 100 Pa.
ProtocolRunner to_pressure(double rate_tolerance = 0) {
    Stage stage;
    stage.pressure = 100;
    return runner_of({stage}, true, rate_tolerance);
}

/// The strains at the scans of a programme.
std::vector<Strain> scans_of_spring(ProtocolRunner& runner) {
    std::vector<Strain> scans;
    drive(runner, time_step, 60, respond,
          [&](const ProtocolState&, const StepInterval&, const IntervalEnd& end, const auto& scan) {
              if (scan) scans.push_back(end.strain);
          });
    return scans;
}

TEST(ListedScans, AreTakenAtTheirStrainsAndStresses) {
    for (const bool stops : {true, false}) {
        SCOPED_TRACE(stops);
        std::vector<Stage> programme(6);
        programme[0].strain = 0.06;
        programme[0].scan_at = {0.01, 0.05};  // and not at the end
        programme[1].strain_z = 0.05;         // less than the shear
        programme[1].shear_xz = -0.2;
        programme[1].scan_at = {-0.05, -0.2};
        programme[2].pressure = 300;
        programme[2].scan_at = {150, 250, 300};
        programme[3].pressure = 300;
        programme[3].stress_yz = -40;
        programme[3].scan_at = {-10, -20};
        programme[4].pressure = 300;
        programme[4].shear_xz = 0;
        programme[4].scan_at = {-0.15, -0.02};
        programme[5].strain_y = 0;
        programme[5].scan_at = {0.01};
        ProtocolRunner runner = runner_of(programme, stops);
        const auto scans = scans_of_spring(runner);
        EXPECT_EQ(runner.hindrance(), "");
        ASSERT_EQ(scans.size(), 12u);
        EXPECT_NEAR(scans[0][1], 0.01, 1e-12);
        EXPECT_NEAR(scans[1][1], 0.05, 1e-12);
        EXPECT_NEAR(scans[2][4], -0.05, 1e-12);
        EXPECT_NEAR(scans[2][2], 0.06 - 0.01 / 4, 1e-12);
        EXPECT_NEAR(scans[3][4], -0.2, 1e-12);
        const double pressures[]{150, 250, 300};
        for (int n = 0; n < 3; ++n) {
            const double pressure = spring_stress(scans[4 + n]).trace() / 3 / pressures[n];
            EXPECT_GT(pressure, 1 - 1e-3) << n;
            EXPECT_LT(pressure, stops ? 1 + 1e-3 : 1.2) << n;
        }
        for (const int n : {7, 8}) {
            const double shear = spring_stress(scans[n])(1, 2) / (n == 7 ? -10 : -20);
            EXPECT_GT(shear, 1 - 2e-3) << n;
            EXPECT_LT(shear, stops ? 1 + 2e-3 : 1.5) << n;
        }
        EXPECT_NEAR(scans[9][4], -0.15, 1e-12);
        EXPECT_NEAR(scans[10][4], -0.02, 1e-12);
        EXPECT_NEAR(scans[11][1], 0.01, 1e-12);
    }
}

// The strains after a move to a stress are known only in the run.
TEST(ListedScans, OutsideTheMoveEndTheProgramme) {
    std::vector<Stage> programme(2);
    programme[0].pressure = 200;
    programme[1].strain_z = 0.3;
    programme[1].scan_at = {0.01, 0.2};
    ProtocolRunner runner = runner_of(programme);
    EXPECT_EQ(scans_of_spring(runner).size(), 1u);
    EXPECT_THAT(
        runner.hindrance(),
        testing::HasSubstr("stage 2 of the programme: there is no scan at strain_z = 0.01: the move goes "
                           "from 0.1"));
}

TEST(StressOfACell, UnreachableStressEndsTheProgramme) {
    struct Case {
        double stress, rate_tolerance;
        const char* why;
    };
    for (const Case& one : {Case{0, 0, "grains would meet their own images at a strain of 0.377778"},
                            Case{150, 0, "s it is still away from it at a strain of -"},
                            Case{150, 0.01, "a cell cannot be stretched further at a strain of -10"}}) {
        ProtocolRunner runner = to_pressure(one.rate_tolerance);
        drive(
            runner, time_step, 60,
            [&](const IntervalEnd&, IntervalResult& result) {
                result.stress = one.stress * Mat3::Identity();
            },
            [](const auto&, const auto&, const auto&, const auto& scan) { EXPECT_FALSE(scan); });
        EXPECT_THAT(runner.hindrance(), testing::AllOf(testing::HasSubstr(one.why),
                                                       testing::HasSubstr("the stress 100 Pa along ")));
    }
}

TEST(StressOfACell, DamagedCheckpointIsRefused) {
    const ProtocolRunner runner = to_pressure();
    EXPECT_TRUE(runner.is_possible(runner.state()));
    const auto possible = [&](auto damage) {
        ProtocolState state = runner.state();
        damage(state.cell);
        return runner.is_possible(state);
    };
    EXPECT_FALSE(possible([](CellControl::State& cell) { cell.direction[1].strain = 1; }));
    EXPECT_FALSE(possible([](CellControl::State& cell) { cell.direction[5].strain = NAN; }));
    EXPECT_FALSE(possible([](CellControl::State& cell) { cell.begin[2] = NAN; }));
}

}  // namespace
}  // namespace mcdem::random_cell_programmes
