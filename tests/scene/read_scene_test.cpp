// Valid scenes: values, defaults, overrides, paths, and the text stored in results.
#include "scene/read/read_scene.h"

#include "scene/read/keys.h"
#include "scene_test_tools.h"

namespace mcdem {
namespace {

TEST(ReadScene, EmptySceneIsTheDefaults) {
    const Scene scene = parse_scene("", "folder/first.toml");
    EXPECT_EQ(scene.name, "first");
    EXPECT_EQ(scene.precision, Precision::single_precision);
    EXPECT_EQ(scene.slots, 16);
    ASSERT_EQ(scene.replicas.size(), 1u);
    const Replica& replica = scene.replicas[0];
    EXPECT_EQ(replica.label, "mc_dem");
    EXPECT_EQ(replica.grains.youngs_modulus, 23.3e3);
    EXPECT_EQ(std::get<GeneratedPacking>(replica.packing.source).count, 514);
    EXPECT_EQ(replica.packing.seed, 1u);
    EXPECT_EQ(scene.text, "");
}

TEST(ReadScene, EveryTypeOfValueIsRead) {
    const Scene scene = parse_scene(R"(
name = "trial"
[grains]
youngs_modulus = 25000          # a whole number is a number
friction = 0.25
[contact]
model = "elastic_sphere"
friction_law = "mindlin"
[packing]
count = 450
seed = 42
[protocol]
stop_at_scans = false
[numerics]
precision = "double"
slots = 48
)",
                                    "trial.toml");
    EXPECT_EQ(scene.name, "trial");
    EXPECT_EQ(scene.precision, Precision::double_precision);
    EXPECT_EQ(scene.slots, 48);
    const Replica& replica = scene.replicas.at(0);
    EXPECT_EQ(replica.grains.youngs_modulus, 25000);
    EXPECT_EQ(replica.grains.friction, 0.25);
    EXPECT_EQ(replica.contact.model, ContactModel::elastic_sphere);
    EXPECT_EQ(replica.contact.friction_law, FrictionLaw::mindlin);
    EXPECT_EQ(std::get<GeneratedPacking>(replica.packing.source).count, 450);
    EXPECT_EQ(replica.packing.seed, 42u);
    EXPECT_FALSE(replica.protocol.stop_at_scans);
}

TEST(ReadScene, ParametersContainEveryKeyAsText) {
    const Scene scene =
        parse_scene("[contact]\ngamma = 0.1\n[packing]\nseed = 5\n[batch]\nreplicas = 2\n", "a.toml");
    const auto& parameters = scene.replicas.at(1).parameters;
    EXPECT_EQ(parameters.size(), keys().size());
    EXPECT_EQ(parameter_text(parameters.at("contact.gamma")), "0.1");
    EXPECT_EQ(parameter_text(parameters.at("packing.seed")), "6") << "the copy's own";
    EXPECT_EQ(parameter_text(parameters.at("protocol.stop_at_scans")), "false");
    EXPECT_EQ(parameter_text(parameters.at("numerics.precision")), "float");
    EXPECT_EQ(parameter_text(parameters.at("packing.file")), "") << "does not apply";
}

TEST(Overrides, ReplaceValuesOfTheFile) {
    const Scene scene =
        parse_scene("[grains]\nfriction = 0.1\n", "a.toml",
                    {"grains.friction=0.2", "contact.model=sphere_to_sphere", "name = \"second try\"",
                     "protocol.stop_at_scans=false", "grains.friction=0.3"});
    const Replica& replica = scene.replicas.at(0);
    EXPECT_EQ(replica.grains.friction, 0.3) << "the last one counts";
    EXPECT_EQ(replica.contact.model, ContactModel::sphere_to_sphere);
    EXPECT_EQ(scene.name, "second try");
    EXPECT_FALSE(replica.protocol.stop_at_scans);
}

TEST(Overrides, CanReplaceABadValue) {
    EXPECT_EQ(parse_scene("[grains]\nfriction = -1\n", "a.toml", {"grains.friction=0.2"})
                  .replicas.at(0)
                  .grains.friction,
              0.2);
}

TEST(Overrides, CanGiveAWholeTable) {
    const Scene scene = parse_scene("", "a.toml", {"grains={friction = 0.4, density = 1000}"});
    EXPECT_EQ(scene.replicas.at(0).grains.friction, 0.4);
    EXPECT_EQ(scene.replicas.at(0).grains.density, 1000);
}

TEST(Overrides, ReplaceTheVariationOfTheirKey) {
    const std::string text = "[batch.vary]\n\"contact.model\" = [\"independent\", \"mc_dem\"]\n";
    EXPECT_EQ(parse_scene(text, "a.toml").replicas.size(), 2u);
    const Scene one = parse_scene(text, "a.toml", {"contact.model=elastic_sphere"});
    ASSERT_EQ(one.replicas.size(), 1u);
    EXPECT_EQ(one.replicas[0].contact.model, ContactModel::elastic_sphere);
    const Scene three = parse_scene(
        text, "a.toml", {"batch.vary.\"contact.model\"=[\"mc_dem\",\"independent\",\"elastic_sphere\"]"});
    ASSERT_EQ(three.replicas.size(), 3u);
    EXPECT_EQ(three.replicas[0].contact.model, ContactModel::mc_dem);
}

TEST(Overrides, AreInTheTextStoredInResults) {
    const std::string text = "# remark\n[batch.vary]\n\"contact.gamma\" = [1, 1.125]\n";
    EXPECT_EQ(parse_scene(text, "a.toml").text, text) << "untouched where nothing changes";
    const Scene changed = parse_scene(text, "a.toml", {"plate.speed=0.05", "batch.replicas=2"});
    const Scene again = parse_scene(changed.text, "a.toml");
    ASSERT_EQ(again.replicas.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(again.replicas[i].parameters, changed.replicas[i].parameters);
        EXPECT_EQ(again.replicas[i].label, changed.replicas[i].label);
    }
    EXPECT_EQ(again.replicas[0].plate.speed, 0.05);
}

constexpr const char* one_grain = "x_m,y_m,z_m,diameter_m\n0.05,0.05,0.05,0.02\n";

TEST(PackingFile, IsRelativeToTheScene) {
    const TestFolder folder;
    const auto packing = folder.write("one.csv", one_grain);
    const auto file = folder.write("scene.toml", "[packing]\nfile = \"one.csv\"\n");
    const Scene scene = read_scene(file);
    const auto* source = std::get_if<PackingFile>(&scene.replicas.at(0).packing.source);
    ASSERT_TRUE(source);
    EXPECT_EQ(source->path, packing.string());
    EXPECT_EQ(parameter_text(scene.replicas[0].parameters.at("packing.count")), "") << "does not apply";
    EXPECT_EQ(scene.name, "scene");
    EXPECT_EQ(
        std::get<PackingFile>(parse_scene(scene.text, "/elsewhere/b.toml").replicas.at(0).packing.source)
            .path,
        packing.string())
        << "the kept text reads from anywhere";
}

TEST(PackingFile, OfAnOverrideIsRelativeToTheCurrentFolderAndReplacesGeneratedGrains) {
    const TestFolder folder;
    const auto packing = folder.write("one.csv", one_grain);
    const auto relative = std::filesystem::relative(packing).string();
    const Scene scene =
        parse_scene("[packing]\ncount = 500\n", "/elsewhere/a.toml", {"packing.file=" + relative});
    EXPECT_EQ(std::get<PackingFile>(scene.replicas.at(0).packing.source).path, packing.string());
}

}  // namespace
}  // namespace mcdem
