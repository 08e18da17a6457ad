// Recordings as vectors: local linear regression through the scans near a bin.
#include "diagnose/observe/observation.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "diagnose/synthetic_scan.h"
#include "scene/programme/programme_text.h"

namespace mcdem {
namespace {

constexpr double start = 0.15, stroke = 0.03;  // [m]

Scan plate_scan(double displacement, double log_force, Phase phase = Phase::load, int cycle = 0) {
    Scan scan;
    scan.cycle = cycle;
    scan.phase = phase;
    scan.plate_z = start - displacement;
    scan.wall_force[static_cast<int>(Wall::plate)].z() = std::exp(log_force);
    return scan;
}

Recording recording_of(std::vector<Scan> scans) {
    Recording recording;
    recording.plate_start = start;
    recording.scans = std::move(scans);
    return recording;
}

const Grid grid{{0.01, 0.02}, 0.004, stroke};

/// Top force while loading at both displacements, then while unloading.
std::array<double, 4> top_forces(const Recording& recording, int discard = 0) {
    const Eigen::VectorXd all = observe(recording, grid, soft_material(), discard);
    EXPECT_EQ(all.size(), static_cast<Eigen::Index>(bins_of(grid).size()));
    for (Eigen::Index bin = 4; bin < all.size(); ++bin) EXPECT_TRUE(std::isnan(all[bin]));
    return {all[0], all[1], all[2], all[3]};
}

TEST(Observation, LocalRegressionIsExactForLinearData) {
    for (const double shift : {0.0, 0.3e-3, 0.7e-3, 1.1e-3}) {
        Recording recording = recording_of({});
        for (double d = shift; d <= stroke; d += 1.3e-3) {
            recording.scans.push_back(plate_scan(d, -3 + 150 * d));
            recording.scans.push_back(plate_scan(d, -5 + 120 * d, Phase::unload));
        }
        const auto forces = top_forces(recording);
        EXPECT_NEAR(forces[0], -3 + 150 * 0.01, 1e-9);
        EXPECT_NEAR(forces[1], -3 + 150 * 0.02, 1e-9);
        EXPECT_NEAR(forces[2], -5 + 120 * 0.01, 1e-9);
        EXPECT_NEAR(forces[3], -5 + 120 * 0.02, 1e-9);
    }
}

TEST(Observation, LocalRegressionHasTriangularWeights) {
    // Scans at -3/4, 0 and 1/2 of the width have the weights 1/4, 1, 1/2. The weighted line through (0.8, 1,
    // 1.5) was computed by hand.
    const Recording recording =
        recording_of({plate_scan(0.007, 0.8), plate_scan(0.010, 1.0), plate_scan(0.012, 1.5)});
    const double n = 1.75, x = -0.1875 + 0.25, xx = 0.140625 + 0.125, y = 0.2 + 1 + 0.75, xy = -0.15 + 0.375;
    EXPECT_NEAR(top_forces(recording)[0], (xx * y - x * xy) / (n * xx - x * x), 1e-9);
}

TEST(Observation, ScansBeyondTheWidthDoNotCount) {
    const std::vector<Scan> inside{plate_scan(0.009, 1), plate_scan(0.011, 2)};
    auto outside = inside;
    outside.push_back(plate_scan(0.0141, 9));
    outside.push_back(plate_scan(0.0059, 9));
    EXPECT_EQ(top_forces(recording_of(outside))[0], top_forces(recording_of(inside))[0]);
    outside.push_back(plate_scan(0.0139, 9));
    EXPECT_NE(top_forces(recording_of(outside))[0], top_forces(recording_of(inside))[0]);
}

TEST(Observation, ASingleScanCountsIfItIsNear) {
    EXPECT_NEAR(top_forces(recording_of({plate_scan(0.0103, 1.7)}))[0], 1.7, 1e-12);
    EXPECT_TRUE(std::isnan(top_forces(recording_of({plate_scan(0.011, 1.7)}))[0]));
    EXPECT_TRUE(std::isnan(top_forces(recording_of({}))[0]));
}

TEST(Observation, RequiresAForceOnThePlate) {
    Recording recording = recording_of({plate_scan(0.009, 1), plate_scan(0.010, 1), plate_scan(0.011, 1)});
    recording.scans[1].wall_force = no_wall_forces();
    EXPECT_NEAR(top_forces(recording)[0], 1, 1e-12);
}

TEST(Observation, CyclesAreAveragedWithoutTheDiscardedOnes) {
    Recording recording = recording_of({});
    for (int cycle = 0; cycle < 3; ++cycle)
        for (double d = 0.0005; d < stroke; d += 0.001)
            for (const Phase phase : {Phase::load, Phase::unload})
                recording.scans.push_back(plate_scan(d, 100 * d + (cycle == 0 ? 9 : cycle), phase, cycle));
    EXPECT_NEAR(top_forces(recording, 1)[1], 2 + 1.5, 1e-9);
    EXPECT_NEAR(top_forces(recording, 1)[3], 2 + 1.5, 1e-9);
    EXPECT_NEAR(top_forces(recording)[1], 2 + 4, 1e-9);
}

TEST(Observation, CellsAreOrderedByObservableThenPhaseThenDisplacement) {
    const auto bins = bins_of(grid);
    ASSERT_EQ(bins.size(), 4 * observables().size());
    for (std::size_t k = 0; k < bins.size(); ++k) {
        EXPECT_EQ(bins[k].observable, static_cast<int>(k / 4));
        EXPECT_EQ(bins[k].phase, k % 4 < 2 ? Phase::load : Phase::unload);
        EXPECT_EQ(bins[k].displacement, grid.displacement[k % 2]);
    }
}

TEST(Observation, OtherObservablesAreInTheirCells) {
    const Lattice lattice(5);
    Recording recording = lattice.recording;
    recording.scans = {lattice.scan, lattice.scan};
    recording.plate_start = lattice.scan.plate_z + 0.01;
    recording.scans[1].phase = Phase::unload;
    for (Contact& contact : recording.scans[1].contacts) contact.force *= 2;
    const Grid two{{0.01, 0.02}, 0.004, stroke};
    const auto all = observe(recording, two, soft_material());
    const auto bins = bins_of(two);
    const auto load = scan_observables(recording, recording.scans[0], soft_material());
    const auto unload = scan_observables(recording, recording.scans[1], soft_material());
    for (std::size_t k = 0; k < bins.size(); ++k) {
        const double seen = all[static_cast<Eigen::Index>(k)];
        const double expected = (bins[k].phase == Phase::load ? load : unload)[bins[k].observable];
        if (bins[k].displacement > 0.015 || std::isnan(expected))
            EXPECT_TRUE(std::isnan(seen)) << k;
        else
            EXPECT_NEAR(seen, expected, 1e-9) << k;
    }
}

/// `scans` per stroke, at equal distances down to `stroke` and up again.
Recording strokes(int scans, int cycles) {
    Recording recording = recording_of({plate_scan(0, 0)});
    recording.scans.clear();
    for (int cycle = 0; cycle < cycles; ++cycle)
        for (int k = 1; k <= scans; ++k) {
            recording.scans.push_back(plate_scan(stroke * k / scans, 0, Phase::load, cycle));
            recording.scans.push_back(plate_scan(stroke * (1 - 1.0 * k / scans), 0, Phase::unload, cycle));
        }
    return recording;
}

TEST(Grid, FollowsTheStrokeAndTheScans) {
    for (const int cycles : {1, 3}) {
        const Grid fine = grid_of(strokes(50, cycles));
        EXPECT_NEAR(fine.stroke, stroke, 1e-12);
        ASSERT_EQ(fine.displacement.size(), 4u);
        const double parts[] = {0.42, 0.61, 0.80, 0.98};
        for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(fine.displacement[k], parts[k] * stroke, 1e-12);
        EXPECT_NEAR(fine.width, 0.12 * stroke, 1e-12);
        EXPECT_NEAR(grid_of(strokes(8, cycles)).width, 1.6 / 8 * stroke, 1e-12);  // three scans wide
    }
}

/// Down in three scans, a hold at 20 mm, up again.
Recording held_recording(const std::string& keep) {
    Stage down, hold, up;
    down.position = start - 0.02;
    up.position = start;
    hold.kind = StageKind::hold;
    hold.keep = keep == "force" ? Controlled::force : Controlled::position;
    hold.time = 2;
    down.scans = up.scans = 3;
    hold.scans = 2;
    Recording recording =
        recording_of({plate_scan(0, -9), plate_scan(0.01, 0), plate_scan(0.015, 0.5), plate_scan(0.02, 1),
                      plate_scan(0.0205, 0.9), plate_scan(0.021, 0.7), plate_scan(0.019, 0, Phase::unload),
                      plate_scan(0.01, -1, Phase::unload), plate_scan(0, -2, Phase::unload)});
    recording.parameters = programme_parameters({down, hold, up});
    return recording;
}

/// Cells of one observable: loading at all displacements, then unloading.
Eigen::VectorXd values_of(const Recording& recording, const Grid& g, Eigen::Index observable) {
    const auto each = static_cast<Eigen::Index>(2 * g.displacement.size());
    return observe(recording, g, soft_material()).segment(observable * each, each);
}

TEST(Observation, APositionHoldShowsRelaxationInItsCell) {
    const Recording recording = held_recording("position");
    const Grid g = grid_of(recording);
    ASSERT_EQ(g.holds.size(), 1u);
    EXPECT_NEAR(g.holds[0].displacement, 0.02, 1e-12);
    EXPECT_EQ(g.holds[0], (HoldScans{3, 4, 5, Controlled::position, Phase::load, g.holds[0].displacement}));
    const Eigen::VectorXd relaxation = values_of(recording, g, index_of(OfProgramme::relaxation));
    for (Eigen::Index k = 0; k < relaxation.size(); ++k)
        EXPECT_EQ(std::isfinite(relaxation[k]), k == 3) << k;  // 98 % of the stroke, loading
    EXPECT_NEAR(relaxation[3], 1 - 0.7, 1e-12);
    EXPECT_FALSE(values_of(recording, g, index_of(OfProgramme::creep)).array().isFinite().any());
    EXPECT_FALSE(values_of(recording, g, index_of(OfProgramme::displacement)).array().isFinite().any());
}

TEST(Observation, AForceHoldShowsCreep) {
    const Recording recording = held_recording("force");
    const Eigen::VectorXd creep = values_of(recording, grid_of(recording), index_of(OfProgramme::creep));
    EXPECT_NEAR(creep[3], 0.001 / 0.021, 1e-12);
}

// Scans of a hold are not part of a stroke.
TEST(Observation, ScansOfAHoldAreNotPartOfTheStroke) {
    Recording recording = held_recording("position");
    const Grid g = grid_of(recording);
    const Eigen::VectorXd before = values_of(recording, g, 0);
    for (const std::size_t held : {4u, 5u}) recording.scans[held].wall_force.back().z() *= 7;
    const Eigen::VectorXd after = values_of(recording, g, 0);
    for (Eigen::Index k = 0; k < before.size(); ++k)
        EXPECT_TRUE(before[k] == after[k] || (std::isnan(before[k]) && std::isnan(after[k])));
}

TEST(Observation, AHoldWithoutAScanBeforeItStartsWithItsFirst) {
    Recording recording = held_recording("position");
    recording.parameters["programme.1.scan_at"] = std::vector<double>{start - 0.01};
    std::erase_if(recording.scans, [](const Scan& scan) {
        return scan.phase == Phase::load && (scan.plate_z < start - 0.0105 && scan.plate_z > start - 0.0203);
    });
    const Grid g = grid_of(recording);
    ASSERT_EQ(g.holds.size(), 1u);
    EXPECT_EQ(g.holds[0].begin, 2);
    EXPECT_EQ(g.holds[0].end, 3);
}

// With prescribed forces displacements are compared, at the forces that loading has at the displacements of
// the grid.
TEST(Observation, DisplacementsAreComparedIfForcesArePrescribed) {
    Recording recording = recording_of({});
    for (double d = 0; d <= stroke; d += stroke / 30) {
        recording.scans.push_back(plate_scan(d, std::log(100 * d)));
        recording.scans.push_back(plate_scan(d, std::log(80 * d), Phase::unload));
    }
    Stage load;
    load.force = 3;
    load.scans = static_cast<int>(recording.scans.size()) - 1;
    recording.parameters = programme_parameters({load});
    const Grid g = grid_of(recording);
    ASSERT_EQ(g.force.size(), g.displacement.size());
    for (std::size_t k = 0; k < g.force.size(); ++k) EXPECT_NEAR(g.force[k], 100 * g.displacement[k], 1e-9);
    const Eigen::VectorXd way = values_of(recording, g, index_of(OfProgramme::displacement));
    EXPECT_NEAR(way[1], g.displacement[1] / g.stroke, 1e-9);
    EXPECT_NEAR(way[5], 1.25 * g.displacement[1] / g.stroke, 1e-9);
    EXPECT_FALSE(values_of(recording, g, 0).array().isFinite().any());
}

}  // namespace
}  // namespace mcdem
