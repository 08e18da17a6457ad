// Impossible effects: amplitudes out of range, plates that would reach the floor, grains without volume.
#include "scene/packing/make_packing.h"
#include "scene/read/read_scene.h"
#include "scene_test_tools.h"

namespace mcdem {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

TEST(EffectsErrors, OutOfRangeAreReportedWithTheirUnits) {
    EXPECT_THAT(
        problems_in(R"([effects]
adhesion = -0.1
viscoelasticity = 1.5
relaxation_time = 0
stiffening = -101
plasticity = 1
bulge_contacts = 2
friction_history = "much"
polydispersity = -1e-3
adhesive = 1
)"),
        ElementsAre(
            "bad.toml:2: effects.adhesion must be a number between 0 and 1000 [J/m2], got -0.1",
            "bad.toml:3: effects.viscoelasticity must be a number between 0 and 1, got 1.5",
            "bad.toml:4: effects.relaxation_time must be a number > 0 and <= 1e+06 [s], got 0",
            "bad.toml:5: effects.stiffening must be a number between -100 and 100, got -101",
            "bad.toml:6: effects.plasticity must be a number between 0 and 0.99, got 1",
            "bad.toml:7: effects.bulge_contacts must be a number between 0 and 1, got 2",
            "bad.toml:8: effects.friction_history must be a number between 0 and 1, got \"much\"",
            "bad.toml:9: effects.polydispersity must be a number between 0 and 10 [m], got -0.001",
            StartsWith("bad.toml:10: effects.adhesive must be a key of a scene, got an unknown one")));
}

TEST(EffectsErrors, OfAPackingFileNameTheFile) {
    const TestFolder folder;
    folder.write("two.csv", "x_m,y_m,z_m,diameter_m\n0.03,0.08,0.16,0.01\n0.13,0.08,0.16,0.02\n");
    const auto scene = folder.write("scene.toml", "[packing]\nfile = \"two.csv\"\n");
    const auto problems = [&](const std::string& override) {
        return problems_of([&] { read_scene(scene, {override}); });
    };
    EXPECT_THAT(
        problems("effects.diameter_error=-0.01"),
        ElementsAre(HasSubstr(
            "two.csv: effects.diameter_error must be above minus the smallest diameter 0.01, got -0.01")));
    // the plate is at 0.1676 m in the middle, and 11 mm lower above the grain at x = 0.03 m
    EXPECT_THAT(problems("effects.plate_tilt_x=0.21"),
                ElementsAre(HasSubstr("the centre of grain 0 must be in the box")));
}

// Every effect can vary between replicas and appears in their labels.
TEST(EffectsErrors, NoErrorsIfEffectsVary) {
    const Scene scene = parse_scene(
        "[effects]\nplasticity = 0.1\n[batch.vary]\n\"effects.adhesion\" = [0, 0.05]\n", "good.toml", {});
    ASSERT_EQ(scene.replicas.size(), 2u);
    EXPECT_EQ(scene.replicas[1].effects.adhesion, 0.05);
    EXPECT_EQ(scene.replicas[1].effects.plasticity, 0.1);
    EXPECT_EQ(scene.replicas[1].label, "adhesion=0.05");
    EXPECT_EQ(parameter_text(scene.replicas[1].parameters.at("effects.adhesion")), "0.05");
}

}  // namespace
}  // namespace mcdem
