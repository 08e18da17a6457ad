// Every scene of scenes/ is valid and agrees with its comments.
#include <numbers>

#include "authors_data.h"
#include "core/parameters.h"
#include "scene/packing/make_packing.h"
#include "scene/read/read_scene.h"
#include "scene/read/scene_warnings.h"
#include "scene_test_tools.h"

namespace mcdem {
namespace {

const std::filesystem::path folder = std::filesystem::path(MCDEM_SOURCE_DIR) / "scenes";

TEST(Scenes, AllValidateAndAreNamedInTheReadme) {
    std::ostringstream readme;
    readme << std::ifstream(folder / "README.md").rdbuf();
    int count = 0;
    for (const auto& file : std::filesystem::directory_iterator(folder)) {
        if (file.path().extension() != ".toml") continue;
        ++count;
        const Scene scene = read_scene(file.path());
        EXPECT_EQ(scene.name, file.path().stem().string());
        EXPECT_FALSE(scene.replicas.empty());
        EXPECT_NE(readme.str().find(file.path().filename().string() + "`"), std::string::npos) << file.path();
    }
    EXPECT_GE(count, 9);
}

/// The times that follow from the grains: soft ones of centimetres keep a second and half a second.
TEST(Scenes, SoftGrainsKeepTheirTimesAndStiffOnesHaveTheirOwn) {
    for (const auto& file : std::filesystem::directory_iterator(folder)) {
        if (file.path().extension() != ".toml") continue;
        for (const Replica& replica : read_scene(file.path()).replicas) {
            EXPECT_EQ(replica.protocol.settle_time, 0.5) << file.path();
            EXPECT_THAT(replica.protocol.relax_time, testing::AnyOf(1.0, 0.2)) << file.path();
        }
    }
    // Glass: shear waves at sqrt(28.69e9 / 2500) = 3388 m/s, Rayleigh waves at 0.9125 times that.
    const std::string glass =
        "[grains]\nyoungs_modulus = 70e9\npoisson_ratio = 0.22\ndensity = 2500\n"
        "[packing]\ndiameter_mean = 1e-3\ndiameter_sd = 0\ndiameter_min = 1e-3\n"
        "diameter_max = 1e-3\n[container]\nsize_x = 0.01\nsize_y = 0.01\n[plate]\nstart = 0.01\nend = 4e-3\n";
    const Scene scene = parse_scene(glass, "glass.toml", {});
    const double own = std::numbers::pi * 0.5e-3 / (3388 * 0.9125);
    EXPECT_NEAR(scene.replicas[0].protocol.relax_time, 2000 * own, 1e-3 * 2000 * own);
    EXPECT_NEAR(scene.replicas[0].protocol.settle_time, 1000 * own, 1e-3 * 1000 * own);
    EXPECT_EQ(find_parameter(scene.replicas[0].parameters, "protocol.relax_time"),
              Parameter(scene.replicas[0].protocol.relax_time));
    EXPECT_EQ(parse_scene(glass, "glass.toml", {"protocol.relax_time=1"}).replicas[0].protocol.relax_time, 1);
}

TEST(Scenes, APlateThatStaysAboveThePackingIsTold) {
    const std::vector<std::string> warnings =
        scene_warnings(parse_scene("[plate]\nstart = 0.2\nend = 0.17\n", "high.toml", {}));
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_THAT(
        warnings[0],
        testing::StartsWith(
            "plate.end: the plate touches no grain: it stays above 0.17 m, and the packing is 0.166"));
    EXPECT_THAT(scene_warnings(parse_scene("", "default.toml", {})), testing::IsEmpty());
}

TEST(Scenes, FirstPackingOfEachCanBeMade) {
    for (const auto& file : std::filesystem::directory_iterator(folder)) {
        if (file.path().extension() != ".toml") continue;
        EXPECT_GT(make_packing(read_scene(file.path()).replicas.at(0)).size(), 0u) << file.path();
    }
}

TEST(Scenes, CompressionComparesAllModelsOnOnePacking) {
    const Scene scene = read_scene(folder / "compression.toml");
    ASSERT_EQ(scene.replicas.size(), name_list<ContactModel>.size());
    for (std::size_t i = 0; i < scene.replicas.size(); ++i) {
        EXPECT_EQ(scene.replicas[i].label, name_list<ContactModel>[i]);
        EXPECT_EQ(scene.replicas[i].packing.seed, scene.replicas[0].packing.seed);
        EXPECT_EQ(scene.replicas[i].protocol.cycles, 1);
    }
}

TEST(Scenes, PaperExperimentHasThePapersParameters) {
    const Scene scene = read_scene(folder / "paper_experiment.toml");
    ASSERT_EQ(scene.replicas.size(), 1u);
    const Replica& replica = scene.replicas[0];
    EXPECT_EQ(replica.contact.model, ContactModel::mc_dem);
    EXPECT_EQ(replica.contact.gamma, 1.125);
    EXPECT_EQ(replica.protocol.cycles, 20);
    EXPECT_EQ(replica.protocol.discard, 5);
    EXPECT_EQ(2 * replica.protocol.scans_per_stroke, 60);
    EXPECT_NEAR(replica.plate.start - replica.plate.end, 30.126e-3, 1e-9);
}

TEST(Scenes, PaperExperimentUsesTheMeasuredPacking) {
    SKIP_WITHOUT_AUTHORS_DATA("input.data");
    const std::string data = (reference::authors_folder / "input.data").string();
    const Scene scene = read_scene(folder / "paper_experiment.toml", {"packing.file=" + data});
    EXPECT_EQ(make_packing(scene.replicas.at(0)).size(), 514u);
}

}  // namespace
}  // namespace mcdem
