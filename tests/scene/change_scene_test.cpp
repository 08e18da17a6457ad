// A scene with changed values of keys equals the scene that states them.
#include "scene/read/change_scene.h"

#include <gmock/gmock.h>

#include "core/errors.h"
#include "scene/read/read_scene.h"

namespace mcdem {
namespace {

using testing::HasSubstr;

const char* const text = R"(
[packing]
count = 20
packing_fraction = 0.5
[container]
size_x = 0.06
size_y = 0.06
[plate]
start = 0.2
[batch]
replicas = 2
[[species]]
name = "soft"
[[species]]
name = "hard"
youngs_modulus = 1e5
[[programme]]
position = 0.15
speed = 0.2
[[programme]]
stage = "hold"
time = 0.1
)";

TEST(WithChanges, EqualsTheSceneThatStatesThem) {
    const Scene scene = parse_scene(text, "a.toml");
    const Scene changed = with_changes(scene, {{"contact.model", "\"mc_dem\""},
                                               {"contact.gamma", "0.7"},
                                               {"protocol.stop_at_scans", "true"},
                                               {"numerics.precision", "\"double\""},
                                               {"output.contacts", "false"},
                                               {"species.2.density", "3"},
                                               {"programme.1.speed", "0.05"}});
    const Scene stated =
        parse_scene(text, "a.toml",
                    {"contact.model=mc_dem", "contact.gamma=0.7", "protocol.stop_at_scans=true",
                     "numerics.precision=double", "output.contacts=false"});
    ASSERT_EQ(changed.replicas.size(), 2u);
    EXPECT_EQ(changed.precision, Precision::double_precision);
    EXPECT_FALSE(changed.output.contacts);
    EXPECT_TRUE(changed.output.positions);
    EXPECT_EQ(changed.slots, scene.slots);
    EXPECT_EQ(changed.text, scene.text);
    for (std::size_t r = 0; r < 2; ++r) {
        const Replica& replica = changed.replicas[r];
        auto expected = stated.replicas[r].parameters;
        expected["species.2.density"] = 3.0;
        expected["programme.1.speed"] = 0.05;
        EXPECT_EQ(replica.parameters, expected);
        EXPECT_EQ(replica.contact.model, ContactModel::mc_dem);
        EXPECT_EQ(replica.contact.gamma, 0.7);
        EXPECT_TRUE(replica.protocol.stop_at_scans);
        EXPECT_EQ(replica.species[1].material.density, 3);
        EXPECT_EQ(replica.species[0].material.density, scene.replicas[r].species[0].material.density);
        EXPECT_EQ(replica.programme[0].speed, 0.05);
        EXPECT_EQ(replica.packing.seed, scene.replicas[r].packing.seed);
    }
}

TEST(WithChanges, RefusesWhatItCannotChange) {
    const Scene scene = parse_scene(text, "a.toml");
    const std::tuple<std::string, std::string, std::string> cases[] = {
        {"packing.count", "30", "that can change on the same packings"},
        {"container.size_x", "0.1", "that can change on the same packings"},
        {"batch.replicas", "3", "that can change on the same packings"},
        {"species.1.fraction", "0.5", "that can change on the same packings"},
        {"species.3.density", "5", "that can change on the same packings"},
        {"grains.density", "5", "that can change on the same packings"},
        {"numerics.slots", "32", "that can change on the same packings"},
        {"programme.3.speed", "1", "that can change on the same packings"},
        {"grains.colour", "1", "that can change on the same packings"},
        {"walls.friction", "-1", "walls.friction must be a number between 0 and 10"},
        {"walls.friction", "[1", "a value of TOML"},
        {"contact.model", "\"hertz\"", "contact.model must be one of"},
        {"plate.end", "1", "plate"},  // above plate.start
    };
    for (const auto& [key, value, part] : cases)
        EXPECT_THAT(
            [&] {
                with_changes(scene, {{key, value}});
            },
            testing::ThrowsMessage<InputError>(HasSubstr(part)))
            << key;
}

}  // namespace
}  // namespace mcdem
