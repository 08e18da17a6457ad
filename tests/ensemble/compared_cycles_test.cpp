// An experiment of two cycles against scenes of one and two: only cycles that are simulated are compared.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ensemble/diagnosis/diagnosis_plan.h"
#include "ensemble/run_scene.h"
#include "ensemble/small_trials.h"
#include "io/results.h"

namespace mcdem {
namespace {

const Scene& scene_of(int cycles) {
    static std::map<int, Scene> scenes;
    if (!scenes.contains(cycles)) {
        Scene scene = small_scene(
            {"protocol.scan_at_start=true", "protocol.cycles=" + std::to_string(cycles), "batch.replicas=1"});
        scene.replicas.resize(1);
        scenes.emplace(cycles, scene);
    }
    return scenes.at(cycles);
}

/// Simulated with the first packing of the scene; the first cycle is the same for any number of cycles.
Experiment experiment_of(int cycles) {
    TestFolder folder;
    Device device;
    RunOptions options;
    options.folder = folder.path / "run";
    EXPECT_EQ(run_scene(device, scene_of(cycles), options).end, RunEnd::done);
    Experiment experiment;
    experiment.name = "measured";
    experiment.recording = read_run(options.folder, ReadWhat::everything).recordings.front();
    experiment.measurement = {1e-5, 1e-5, 0.01, 1e-4};
    return experiment;
}

DiagnosisPlan plan(const Scene& scene, const Experiment& experiment, std::vector<std::string>* notes) {
    PlanOptions options;
    options.on_note = [=](const std::string& note) { notes->push_back(note); };
    return plan_of(scene, {experiment}, options);
}

Eigen::VectorXd observed_by(const DiagnosisPlan& plan) {
    return observe(plan.experiments.front().recording, plan.common.grid, plan.common.material,
                   plan.common.discard);
}

TEST(ComparedCycles, AreThoseOfTheScene) {
    const Experiment one = experiment_of(1), two = experiment_of(2);
    ASSERT_EQ(two.recording.scans.size(), 2 * one.recording.scans.size() - 1);
    std::vector<std::string> notes;
    const DiagnosisPlan same = plan(scene_of(1), one, &notes), first = plan(scene_of(1), two, &notes);
    EXPECT_EQ(notes, (std::vector<std::string>{
                         "measured: only the first cycle is compared, of 2; protocol.cycles in the scene is "
                         "the number of cycles to simulate"}));
    EXPECT_EQ(first.library.packings.front().model.replica.protocol.cycles, 1);
    EXPECT_TRUE(mcdem::same(observed_by(first), observed_by(same)));

    notes.clear();
    const DiagnosisPlan both = plan(scene_of(2), two, &notes), only = plan(scene_of(2), one, &notes);
    EXPECT_TRUE(notes.empty());
    EXPECT_EQ(both.library.packings.front().model.replica.protocol.cycles, 2);
    EXPECT_EQ(only.library.packings.front().model.replica.protocol.cycles, 1);
    EXPECT_FALSE(mcdem::same(observed_by(both), observed_by(same))) << "the second cycle differs";
    EXPECT_TRUE(mcdem::same(observed_by(only), observed_by(same)));
}

TEST(ComparedCycles, IncludeOneThatIsNotDiscarded) {
    Scene scene = scene_of(1);
    scene.replicas.front().protocol.discard = 1;
    const Experiment two = experiment_of(2);
    EXPECT_EQ(compared_cycles(scene, two).recording.scans.size(), two.recording.scans.size());
}

TEST(OtherMaterials, AreStatedByTheExperimentAndNotTheScenes) {
    const Replica replica =
        small_scene({"grains.youngs_modulus=23300", "grains.friction=0.1"}).replicas.front();
    Experiment experiment;
    EXPECT_THAT(other_materials(replica, experiment.materials), testing::IsEmpty());
    experiment.materials = {{"grains.youngs_modulus", 23300}, {"grains.friction", 0.1}};
    EXPECT_THAT(other_materials(replica, experiment.materials), testing::IsEmpty());
    experiment.materials["grains.youngs_modulus"] = 3e4;
    EXPECT_THAT(other_materials(replica, experiment.materials),
                testing::ElementsAre("grains.youngs_modulus = 30000 (scene: 23300)"));
}

}  // namespace
}  // namespace mcdem
