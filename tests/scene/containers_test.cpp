// Cylinders and periodic containers: keys, errors, and packings that fill them.
#include "core/container.h"
#include "largest_overlap.h"
#include "scene/packing/generate_packing.h"
#include "scene/packing/make_packing.h"
#include "scene/packing/packing_state.h"
#include "scene/read/read_scene.h"
#include "scene_test_tools.h"

namespace mcdem {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string sparse = "[packing]\ncount = 150\npacking_fraction = 0.5\n";

TEST(Containers, AreReadWithTheirSizes) {
    const auto box_of = [](const std::string& text, const std::vector<std::string>& overrides = {}) {
        return parse_scene(text + sparse, "good.toml", overrides).replicas.at(0).box;
    };
    const Box plain = box_of("");
    EXPECT_EQ(plain.shape, ContainerShape::box);
    EXPECT_EQ(plain.size_x, 0.165191);
    EXPECT_EQ(box_of("[box]\nsize_x = 0.1\n").size_x, 0.1);
    EXPECT_EQ(box_of("[container]\nsize_y = 0.2\n").size_y, 0.2);
    EXPECT_EQ(box_of("[box]\nsize_x = 0.1\n", {"container.size_x=0.2"}).size_x, 0.2);
    const Box cell = box_of("[container]\nshape = \"periodic\"\nsize_x = 0.1\n");
    EXPECT_EQ(cell.shape, ContainerShape::periodic);
    EXPECT_EQ(cell.size_x, 0.1);
    const Box cylinder = box_of("[container]\nshape = \"cylinder\"\nradius = 0.06\n");
    EXPECT_EQ(cylinder.shape, ContainerShape::cylinder);
    EXPECT_EQ(cylinder.size_x, 0.12);
    EXPECT_EQ(cylinder.size_y, 0.12);
}

TEST(Containers, OfSeveralShapesCanBeInOneRun) {
    const Scene scene =
        parse_scene("[container]\nsize_x = 0.1\nsize_y = 0.11\nradius = 0.06\n" + sparse +
                        "[batch.vary]\n\"container.shape\" = [\"box\", \"cylinder\", \"periodic\"]\n",
                    "good.toml", {});
    ASSERT_EQ(scene.replicas.size(), 3u);
    EXPECT_EQ(scene.replicas[0].box.size_x, 0.1);
    EXPECT_EQ(scene.replicas[1].box.size_x, 0.12);
    EXPECT_EQ(scene.replicas[2].box.size_y, 0.11);
    EXPECT_EQ(scene.replicas[1].label, "cylinder");
    EXPECT_EQ(parameter_text(scene.replicas[1].parameters.at("container.radius")), "0.06");
    EXPECT_EQ(parameter_text(scene.replicas[1].parameters.at("box.size_x")), "") << "does not apply";
    EXPECT_EQ(parameter_text(scene.replicas[2].parameters.at("container.radius")), "");
    EXPECT_EQ(parameter_text(scene.replicas[2].parameters.at("container.size_x")), "0.1");
}

TEST(Containers, TooSmallForTheirGrainsAreRefused) {
    EXPECT_THAT(
        problems_in("[container]\nshape = \"cylinder\"\nradius = 0.024\n" + sparse +
                    "[plate]\nstart = 3\nend = 2\n"),
        ElementsAre(AllOf(HasSubstr("bad.toml:3: container.radius must be at least the largest diameter"),
                          testing::Not(HasSubstr("()")))));
    const std::string cell =
        "[container]\nshape = \"periodic\"\nsize_x = 0.056\nsize_y = 0.2\n[plate]\nstart = 3\nend = 2\n";
    EXPECT_THAT(problems_in(cell + sparse),
                ElementsAre(AllOf(HasSubstr("bad.toml:3: container.size_x must be at least 0.0566"),
                                  HasSubstr("two grains could meet twice"))));
    EXPECT_NO_THROW(parse_scene(cell + sparse, "good.toml", {"numerics.skin=0.1"}));
    const TestFolder folder;
    const auto one = folder.write("one.csv", "x_m,y_m,z_m,diameter_m\n0.2,-0.3,0.02,0.024\n");
    const std::string file = "[packing]\nfile = \"" + one.string() + "\"\n";
    EXPECT_THAT(problems_in(cell + file),
                Contains(AllOf(HasSubstr("one.csv"), HasSubstr("container.size_x must be"))));
    EXPECT_NO_THROW(parse_scene(cell + file, "good.toml", {"container.size_x=0.06"}));
    EXPECT_THAT(problems_in("[container]\nshape = \"cylinder\"\nradius = 0.06\n" + file),
                ElementsAre(HasSubstr("the centre of grain 0 must be in the cylinder of radius 0.06 m")));
}

TEST(Containers, ACylinderAcceptsOnlyGrainsInsideIt) {
    const Box cylinder{0.2, 0.2, ContainerShape::cylinder};
    const Packing packing{{{0.1, 0.1, 0.05}, {0.175, 0.175, 0.05}, {0.16, 0.16, 0.05}}, {0.02, 0.02, 0.02}};
    EXPECT_THAT(packing_problems(packing, cylinder, {0.1}, "p"), ElementsAre(HasSubstr("centre of grain 1")))
        << "corners of the square around it are outside";
    EXPECT_TRUE(packing_problems({{{0.1, 0.1, 0.05}, {0.17, 0.1, 0.05}}, {0.02, 0.02}}, cylinder, {0.1}, "p")
                    .empty());
}

GeneratedPacking drawn(int count, double fraction) {
    GeneratedPacking wanted;
    wanted.count = count;
    wanted.packing_fraction = fraction;
    return wanted;
}

// Without side walls there are no gaps next to walls.
TEST(GeneratedPacking, FillsContainersOfEveryShape) {
    for (const auto& [box, fraction] : {std::pair(Box{0.13, 0.13, ContainerShape::cylinder}, 0.53),
                                        std::pair(Box{0.12, 0.1, ContainerShape::periodic}, 0.56),
                                        std::pair(Box{0.058, 0.06, ContainerShape::periodic}, 0.52)}) {
        const GeneratedPacking wanted = drawn(200, fraction);
        Replica replica;
        replica.box = box;
        replica.plate.start = 1.01 * expected_height(wanted, box);
        replica.packing.source = wanted;
        const Packing packing = make_packing(replica);
        const double height = expected_height(wanted, box);
        EXPECT_NEAR(height * box.size_x * box.size_y * floor_share(box) * fraction, 200 * 5.25e-6, 2e-5);
        EXPECT_LT(largest_overlap(packing, box, 1.003 * height), 0.02)
            << name(box.shape) << ' ' << box.size_x;
        // With sparse contacts the container would not be filled.
        const auto state = packing_state(packing, box, {height});
        EXPECT_LT(state.relative_overlap, 0.02);
        double far = 0, high = 0;
        for (const Vec3& p : packing.position) {
            far = std::max(far, from_axis(box, p).norm());
            high = std::max(high, p.z());
            EXPECT_TRUE(p.x() >= 0 && p.x() < box.size_x && p.y() >= 0 && p.y() < box.size_y);
        }
        EXPECT_GT(high, height - 0.02);
        if (is_cylinder(box)) {
            EXPECT_LT(far, cylinder_radius(box) - 0.0089);
        }
    }
}

TEST(PackingState, OfAPeriodicContainerIncludesContactsAcrossItsBoundaries) {
    const Packing two{{{0.005, 0.05, 0.05}, {0.094, 0.05, 0.05}}, {0.02, 0.02}};
    const auto over = packing_state(two, {0.1, 0.1, ContainerShape::periodic}, {0.2});
    EXPECT_EQ(over.coordination_number, 1);
    EXPECT_NEAR(over.deepest_overlap, 0.009, 1e-12);
    EXPECT_EQ(packing_state(two, {0.1, 0.1}, {0.2}).coordination_number, 1) << "each with a wall";
    const Packing third{{{0.005, 0.05, 0.05}, {0.05, 0.006, 0.05}}, {0.02, 0.02}};
    EXPECT_NEAR(packing_state(third, {0.1, 0.1, ContainerShape::cylinder}, {0.2}).deepest_overlap, 0.005,
                1e-12);
}

}  // namespace
}  // namespace mcdem
