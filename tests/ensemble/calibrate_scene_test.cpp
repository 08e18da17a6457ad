#include "ensemble/calibrate_scene.h"

#include <gmock/gmock.h>

#include <fstream>

#include "core/errors.h"
#include "ensemble/make_packings.h"
#include "ensemble/small_scene.h"

namespace mcdem {
namespace {

/// One grain between two plates: the top force is a smooth function of gamma.
Scene one_grain(const std::filesystem::path& folder, double gamma) {
    std::ofstream(folder / "grain.csv") << "x_m,y_m,z_m,diameter_m\n0.03,0.03,0.01,0.02\n";
    return small_scene({"packing.file=" + (folder / "grain.csv").string(), "contact.model=mc_dem",
                        "contact.gamma=" + std::to_string(gamma), "plate.start=0.0201", "plate.end=0.018",
                        "protocol.scans_per_stroke=2", "grains.poisson_ratio=0.45"});
}

TEST(CalibrateScene, FindsTheGammaOfTheReference) {
    TestFolder folder;
    Device device;
    const Scene made_with = one_grain(folder.path, 0.8765);
    const auto reference = simulate(device, made_with, make_packings(made_with), 1000);
    CalibrateOptions options;
    options.search.tolerance = 1e-3;
    int rounds = 0;
    options.on_progress = [&](int round, double fraction) {
        rounds = round + 1;
        EXPECT_LE(fraction, 1 + 1e-9);
    };
    const auto result = calibrate_scene(device, one_grain(folder.path, 0.5), replicas_of(reference), options);
    EXPECT_NEAR(result.found.gamma, 0.8765, 2e-3);
    EXPECT_TRUE(result.found.converged);
    EXPECT_NEAR(result.displacement, 2.1e-3, 1e-6);
    EXPECT_EQ(result.target.value, reference.front().scans[1].top_force());
    EXPECT_EQ(rounds, static_cast<int>(result.found.rounds.size()));
}

// The error of a force over the slope is that of gamma; independent errors add as squares.
TEST(CalibrateScene, TheErrorContainsThatOfTheReference) {
    SceneCalibration result;
    result.found.standard_error = 0.003;
    result.found.slope = 2;
    EXPECT_EQ(result.standard_error(), 0.003);
    EXPECT_FALSE(result.knows_scatter());
    result.target = {5, 0.008, 4};
    result.simulated = {5, 0.024, 4};
    EXPECT_NEAR(result.standard_error(), 0.013, 1e-12);  // 3, 4 and 12 thousandths
    EXPECT_TRUE(result.knows_scatter());
}

// Forces are proportional to the modulus: the model is fitted by E alone.
TEST(CalibrateScene, FindsTheModulusForAModelWithoutGamma) {
    TestFolder folder;
    Device device;
    const auto of_modulus = [&](double modulus) {
        Scene scene = one_grain(folder.path, 1);
        for (Replica& replica : scene.replicas) {
            replica.contact.model = ContactModel::hyperelastic_sphere;
            replica.grains.youngs_modulus = modulus;
        }
        return scene;
    };
    const Scene made_with = of_modulus(26e3);
    auto reference = simulate(device, made_with, make_packings(made_with), 1000);
    reference.front().parameters = {{"grains.youngs_modulus", "26000"}, {"grains.friction", "0.5"}};
    CalibrateOptions options;
    options.model = ContactModel::hyperelastic_sphere;
    options.search.tolerance = 1e-3;
    std::vector<std::string> notes;
    options.on_note = [&](const std::string& note) { notes.push_back(note); };
    const auto result = calibrate_scene(device, of_modulus(20e3), replicas_of(reference), options);
    EXPECT_EQ(result.youngs_modulus, 20e3);
    EXPECT_NEAR(result.found.gamma, 1.3, 3e-3);
    EXPECT_TRUE(result.found.converged);
    EXPECT_THAT(notes,
                testing::ElementsAre(testing::HasSubstr("the reference has grains.friction = 0.5 (scene:")))
        << "but not the modulus, which is searched for";
    options.bracket = {0.5, 0.6};
    EXPECT_THAT([&] { calibrate_scene(device, of_modulus(20e3), replicas_of(reference), options); },
                testing::ThrowsMessage<RunError>(testing::HasSubstr("E over the scene's = 0.6")));
}

TEST(CalibrateScene, RefusesAPlateThatStopsEarly) {
    TestFolder folder;
    Device device;
    const Scene scene = one_grain(folder.path, 1);
    auto reference = simulate(device, scene, make_packings(scene), 1000);
    for (auto& scan : reference.front().scans) scan.plate_z -= 1e-3;
    EXPECT_THAT([&] { calibrate_scene(device, scene, replicas_of(reference), {}); },
                testing::ThrowsMessage<InputError>(testing::HasSubstr("3.100 mm, got 2.100 mm")));
}

TEST(CalibrateScene, RunsOneMcDemReplicaForEachPacking) {
    const auto replicas = calibration_replicas(small_scene({"batch.replicas=3"}));
    ASSERT_EQ(replicas.size(), 3u);
    for (std::size_t r = 0; r < 3; ++r) {
        EXPECT_EQ(replicas[r].contact.model, ContactModel::mc_dem);
        EXPECT_EQ(replicas[r].packing.seed, r + 1);
    }
}

TEST(CalibrateScene, RefusesOtherVariedKeys) {
    const auto scene = small_scene({"batch.vary.grains.friction=[0.01, 0.02]"});
    EXPECT_THAT([&] { calibration_replicas(scene); },
                testing::ThrowsMessage<InputError>(testing::HasSubstr("grains.friction must be the same")));
}

}  // namespace
}  // namespace mcdem
