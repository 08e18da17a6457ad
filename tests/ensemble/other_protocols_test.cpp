// Other protocols of the plate, by which a diagnosis could tell effects apart.
#include "ensemble/diagnosis/other_protocols.h"

#include <gtest/gtest.h>

#include "ensemble/diagnosis/diagnose_experiment.h"
#include "ensemble/small_trials.h"

namespace mcdem {
namespace {

Trial relaxing(const SmallTrials& small, double viscoelasticity) {
    Trial trial = small.trial();
    trial.model.replica.effects.viscoelasticity = viscoelasticity;
    trial.model.replica.effects.relaxation_time = 0.2;
    trial.model.replica.plate.speed = 0.01;  // 1 s down; a fast plate shakes the packing
    return trial;
}

Eigen::VectorXd observed(const SmallTrials& small, Trial trial, const OtherProtocol* protocol) {
    Device device;
    if (protocol) protocol->change(trial.model.replica);
    return observe_trials(device, protocol ? protocol->common : small.common, {trial}, small.store, {})
        .row(0)
        .transpose();
}

// The top force relaxes by at most the relaxing fraction, and only for viscoelastic grains.
TEST(OtherProtocols, AHoldAtFullStrokeShowsRelaxation) {
    const SmallTrials small;
    const Trial soft = relaxing(small, 0.4), elastic = relaxing(small, 0);
    const auto protocols = other_protocols(small.common, soft.model.replica, false);
    ASSERT_EQ(protocols.size(), 2u);
    EXPECT_EQ(protocols[0].what, "hold the plate at full stroke for 0.6 s");
    const auto cells = cells_of(small.common.grid);
    const Eigen::VectorXd stroke = observed(small, soft, nullptr),
                          held = observed(small, soft, &protocols[0]),
                          rigid = observed(small, elastic, &protocols[0]);
    int found = 0;
    for (std::size_t c = 0; c < cells.size(); ++c) {
        const auto cell = static_cast<Eigen::Index>(c);
        if (cells[c].observable != index_of(OfProgramme::relaxation)) {
            EXPECT_EQ(std::isfinite(stroke[cell]), std::isfinite(held[cell])) << c;
            continue;
        }
        EXPECT_TRUE(std::isnan(stroke[cell]));
        if (std::isnan(held[cell])) continue;
        ++found;
        EXPECT_EQ(cells[c].displacement, small.common.grid.displacement.back());
        EXPECT_GT(held[cell], rigid[cell] + 0.1);
    }
    EXPECT_EQ(found, 1);
}

TEST(OtherProtocols, OneMoreCycleHasTheCellsOfOne) {
    const SmallTrials small;
    Trial trial = small.trial();
    trial.model.replica.effects.plasticity = 0.3;
    const auto protocols = other_protocols(small.common, trial.model.replica, false);
    const Eigen::VectorXd one = observed(small, trial, nullptr), two = observed(small, trial, &protocols[1]);
    EXPECT_FALSE(same(one, two));
    for (Eigen::Index cell = 0; cell < one.size(); ++cell)
        EXPECT_TRUE(std::isfinite(two[cell]) || !std::isfinite(one[cell])) << cell;
}

// A slower plate leaves more time to relax: of the elastic force at full stroke less is left.
TEST(OtherProtocols, ASlowerPlateShowsTheRate) {
    const SmallTrials small;
    const Trial soft = relaxing(small, 0.4), elastic = relaxing(small, 0);
    const auto protocols = other_protocols(small.common, soft.model.replica, true);
    ASSERT_EQ(protocols.size(), 3u);
    EXPECT_EQ(protocols[2].what, "press 4 times slower");
    const auto cells = cells_of(small.common.grid);
    const auto force = [&](const Trial& trial, const OtherProtocol* protocol) {
        const Eigen::VectorXd seen = observed(small, trial, protocol);
        for (std::size_t c = 0; c < cells.size(); ++c)
            if (observables()[static_cast<std::size_t>(cells[c].observable)].name == "top_force" &&
                cells[c].displacement == small.common.grid.displacement.back() &&
                cells[c].phase == Phase::load)
                return seen[static_cast<Eigen::Index>(c)];
        return std::nan("");
    };
    const double left = force(soft, nullptr) / force(elastic, nullptr),
                 left_if_slower = force(soft, &protocols[2]) / force(elastic, &protocols[2]);
    EXPECT_LT(left_if_slower, left - 0.02);
    EXPECT_GT(left_if_slower, 0.6 - 0.02);  // all of 0.4 has relaxed
}

TEST(OtherProtocols, AreNotMadeOfAProgramme) {
    const SmallTrials small;
    Replica replica = small.model.replica;
    replica.programme.resize(1);
    EXPECT_TRUE(other_protocols(small.common, replica, true).empty());
}

/// A scene with little friction and an experiment with adhesion, whose plate is said to pause for 0.2 s at
/// this speed [m/s]. The candidates are two laws of adhesion, which differ only in their friction.
Diagnosis diagnosis_with_pauses(double speed) {
    const TestFolder folder;
    Device device;
    Scene scene = small_scene({"plate.end=0.074", "plate.speed=0.03", "protocol.scans_per_stroke=6",
                               "protocol.stop_at_scans=false", "protocol.scan_at_start=true",
                               "contact.friction_law=saturated", "grains.friction=0.001"});
    scene.replicas.resize(1);
    Trial truth{{scene.replicas.front(), {{1e-5, 1e-5, 0.01, 1e-4}}}, make_packings(scene).front()};
    truth.model.replica.effects.adhesion = 0.3;  // from 0.15 on both take away all of the gap
    truth.keep_recording = true;
    const TrialSettings common{scene, Grid{{0.01}, 0.005, 0.014}, reference_material(truth.model), 0, "test"};
    const ObservationStore store(folder.path / "simulations");
    observe_trials(device, common, {truth}, store, {});
    Experiment experiment;
    experiment.name = "measured";
    experiment.recording = kept_recordings(device, common, {truth}, store).front();
    experiment.measurement = truth.model.instrument.stated;
    experiment.plate_pause = 0.2;
    experiment.plate_speed = speed;
    DiagnoseOptions options;
    options.folder = folder.path / "diagnosis";
    options.candidates = {"adhesion", "adhesion_net_friction"};
    options.replicates = 8;
    options.pairs = 2;
    options.confirmations = 4;
    options.limits.group_share = 0.3;  // both are in one group, but not the modulus, which gains half of that
    return diagnose_experiment(device, scene, {experiment}, options);
}

bool recommends_motion(const Diagnosis& diagnosis) {
    return std::ranges::any_of(diagnosis.next, [](const NextStep& step) {
        return step.what.starts_with("simulate the motion of the experiment's plate");
    });
}

// The plate is 30 times slower than that of the scene: pauses are recommended, not simulated.
TEST(OtherProtocols, GetAPowerInADiagnosis) {
    const Diagnosis diagnosis = diagnosis_with_pauses(0.001);
    ASSERT_EQ(diagnosis.verdict, Verdict::group);
    int powers = 0;
    for (const NextStep& step : diagnosis.next)
        for (const char* what : {"hold the plate at full stroke for 0.3 s, to distinguish adhesion",
                                 "press one more cycle, to distinguish adhesion"})
            if (step.what.starts_with(what)) {
                ASSERT_TRUE(step.power);
                EXPECT_TRUE(*step.power >= 0 && *step.power <= 1) << *step.power;
                ++powers;
            }
    EXPECT_EQ(powers, 2);
    EXPECT_TRUE(recommends_motion(diagnosis));
    EXPECT_TRUE(diagnosis.refinements.empty());
}

TEST(OtherProtocols, PausesOfThePlateAreSimulatedIfThereIsAGap) {
    const Diagnosis diagnosis = diagnosis_with_pauses(0.06);
    ASSERT_EQ(diagnosis.refinements.size(), 2u);
    const Refinement &pause = diagnosis.refinements[0], &speed = diagnosis.refinements[1];
    EXPECT_EQ(pause.key, "protocol.pause");
    EXPECT_EQ(pause.to, 0.02) << "relax_time: grains rest by then";
    EXPECT_EQ(speed.key, "plate.speed");
    EXPECT_EQ(speed.from, 0.03);
    EXPECT_EQ(speed.to, 0.06);
    EXPECT_TRUE(pause.done && speed.done);
    EXPECT_FALSE(recommends_motion(diagnosis));
}

}  // namespace
}  // namespace mcdem
