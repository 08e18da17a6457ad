// Every scene of scenes/ is valid and agrees with its comments.
#include "authors_data.h"
#include "scene/packing/make_packing.h"
#include "scene/read/read_scene.h"
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
