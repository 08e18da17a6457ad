// Copies and variations of a replica.
#include <set>

#include "scene/read/read_scene.h"
#include "scene_test_tools.h"

namespace mcdem {
namespace {

using testing::ElementsAre;

std::vector<std::string> labels(const Scene& scene) {
    std::vector<std::string> all;
    for (const Replica& replica : scene.replicas) all.push_back(replica.label);
    return all;
}

TEST(Replicas, CopiesHaveDifferentSeeds) {
    const Scene scene = parse_scene("[packing]\nseed = 10\n[batch]\nreplicas = 3\n", "a.toml");
    EXPECT_THAT(labels(scene), ElementsAre("mc_dem #1", "mc_dem #2", "mc_dem #3"));
    for (int copy = 0; copy < 3; ++copy) EXPECT_EQ(scene.replicas[copy].packing.seed, 10u + copy);
}

TEST(Replicas, VariationsMultiplyInTheOrderOfTheFile) {
    const Scene scene = parse_scene(R"(
[batch]
replicas = 2
[batch.vary]
"grains.friction" = [0.01, 0.03]
"contact.model" = ["independent", "mc_dem"]
)",
                                    "a.toml");
    EXPECT_THAT(labels(scene), ElementsAre("friction=0.01, independent #1", "friction=0.01, independent #2",
                                           "friction=0.01, mc_dem #1", "friction=0.01, mc_dem #2",
                                           "friction=0.03, independent #1", "friction=0.03, independent #2",
                                           "friction=0.03, mc_dem #1", "friction=0.03, mc_dem #2"));
    for (std::size_t i = 0; i < 8; ++i) {
        const Replica& replica = scene.replicas[i];
        EXPECT_EQ(replica.packing.seed, 1 + i % 2) << "copy n of every setting starts alike";
        EXPECT_EQ(replica.grains.friction, i < 4 ? 0.01 : 0.03);
        EXPECT_EQ(replica.contact.model, i / 2 % 2 == 0 ? ContactModel::independent : ContactModel::mc_dem);
        EXPECT_EQ(parameter_text(replica.parameters.at("grains.friction")), i < 4 ? "0.01" : "0.03");
    }
}

TEST(Replicas, KeysWithoutQuotesAreEquivalent) {
    const Scene quoted = parse_scene("[batch.vary]\n\"contact.gamma\" = [1, 2]\n", "a.toml");
    const Scene dotted = parse_scene("[batch.vary]\ncontact.gamma = [1, 2]\n", "a.toml");
    EXPECT_EQ(labels(quoted), labels(dotted));
    EXPECT_THAT(labels(dotted), ElementsAre("gamma=1", "gamma=2"));
}

TEST(Replicas, LabelsDistinguishKeysWithTheSameName) {
    const Scene scene =
        parse_scene("[batch.vary]\n\"grains.friction\" = [0.1]\n\"walls.friction\" = [0.2, 0.3]\n", "a.toml");
    EXPECT_THAT(labels(scene), ElementsAre("grains.friction=0.1, walls.friction=0.2",
                                           "grains.friction=0.1, walls.friction=0.3"));
}

TEST(Replicas, LabelsDiffer) {
    const Scene scene = read_scene(std::string(MCDEM_SOURCE_DIR) + "/scenes/sweep_gamma.toml");
    const auto all = labels(scene);
    EXPECT_EQ(std::set<std::string>(all.begin(), all.end()).size(), 4u * 3 * 3);
}

TEST(Replicas, GeneratedPackingsMayVary) {
    const Scene scene = parse_scene("[batch.vary]\n\"packing.packing_fraction\" = [0.59, 0.6]\n", "a.toml");
    EXPECT_EQ(std::get<GeneratedPacking>(scene.replicas.at(1).packing.source).packing_fraction, 0.6);
}

}  // namespace
}  // namespace mcdem
