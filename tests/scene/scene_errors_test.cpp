// Invalid scenes: all problems are reported at once, each with its position, the expected and the actual
// value.
#include "scene/read/read_scene.h"
#include "scene_test_tools.h"

namespace mcdem {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;
using testing::StartsWith;

TEST(SceneErrors, ABoxTooLargeForSinglePrecisionIsRefused) {
    const TestFolder folder;
    const auto two =
        folder.write("two.csv", "x_m,y_m,z_m,diameter_m\n0.5,0.5,0.0002,0.000415\n0.5,0.5,0.0006,0.000415\n");
    const std::string box = "[box]\nsize_x = 1.0\nsize_y = 1.0\n[plate]\nstart = 1.0\nend = 0.999\n";
    const std::string file = box + "[packing]\nfile = \"" + two.string() + "\"\n";
    EXPECT_THAT(problems_in(file),
                ElementsAre(AllOf(HasSubstr("numerics.precision must be double"), HasSubstr("0.000208 m"))));
    EXPECT_NO_THROW(parse_scene(file, "good.toml", {"numerics.precision=double"}));
    const std::string drawn = box +
                              "[packing]\ncount = 9000000\ndiameter_min = 0.0004\ndiameter_mean = 0.002\n"
                              "diameter_sd = 0.0001\ndiameter_max = 0.003\n";
    EXPECT_THAT(problems_in(drawn), ElementsAre(HasSubstr("numerics.precision must be double")));
    EXPECT_NO_THROW(parse_scene(drawn, "good.toml", {"numerics.precision=double"}));
    EXPECT_NO_THROW(parse_scene(drawn, "good.toml", {"packing.diameter_min=0.0013"}));
}

TEST(SceneErrors, ABoxInMillimetresIsDetected) {
    using testing::Contains;
    const TestFolder folder;
    const auto two =
        folder.write("two.csv", "x_m,y_m,z_m,diameter_m\n0.01,0.01,0.01,0.02\n0.03,0.01,0.01,0.02\n");
    EXPECT_THAT(problems_in("[box]\nsize_x = 80\nsize_y = 80\n[packing]\nfile = \"" + two.string() + "\"\n"),
                Contains(HasSubstr(
                    "two.csv: the box must be in metres and fit the packing, 0.04 m wide, got 80 x 80 m")));
}

TEST(SceneErrors, OfAllKindsAreReportedTogether) {
    const auto problems = problems_in(R"(speed = 3
[grains]
youngs_modulus = -23.3e3
poisson_ratio = 0.7
friction = "low"
fricton = 0.03
[contact]
model = "mcdem"
[plate]
start = 0.1
end = 0.2
[protocol]
cycles = 2.5
stop_at_scans = 1
scans_per_stroke = 0
[numerics]
slots = 17
[wall]
friction = 0.1
[batch.vary]
"contact.gamma" = [1, "high"]
"output.contacts" = [true, false]
)",
                                      {"packing.count=0"});
    EXPECT_THAT(
        problems,
        ElementsAre(
            "bad.toml:1: speed must be a key of a scene, got an unknown one (did you mean plate.speed?)",
            "bad.toml:3: grains.youngs_modulus must be a number > 0 and <= 1e+13 [Pa], got -23300",
            "bad.toml:4: grains.poisson_ratio must be a number between 0 and 0.5, got 0.7",
            "bad.toml:5: grains.friction must be a number between 0 and 10, got \"low\"",
            "bad.toml:6: grains.fricton must be a key of a scene, got an unknown one (did you mean "
            "grains.friction?)",
            "bad.toml:8: contact.model must be one of independent, point_force_on_sphere, sphere_to_sphere, "
            "elastic_half_space, mc_dem, elastic_sphere, hyperelastic_sphere, got \"mcdem\"",
            "bad.toml:11: plate.end must be below plate.start = 0.1, got 0.2",
            "bad.toml:13: protocol.cycles must be a whole number between 1 and 10000, got 2.5",
            "bad.toml:14: protocol.stop_at_scans must be true or false, got 1",
            "bad.toml:15: protocol.scans_per_stroke must be a whole number between 1 and 10000, got 0",
            "bad.toml:17: numerics.slots must be a whole number between 0 and 64, a multiple of 16, got 17",
            "bad.toml:18: wall must be a table of a scene, got an unknown one (did you mean walls?)",
            "bad.toml:21: batch.vary.\"contact.gamma\" must be a number between 0 and 10, got \"high\"",
            "bad.toml:22: batch.vary.\"output.contacts\" must be a key of which replicas have their own, got "
            "one of the "
            "whole run",
            "--set packing.count: packing.count must be a whole number between 1 and 10000000, got 0"));
}

TEST(SceneErrors, GiveLineAndColumnOfBadSyntax) {
    EXPECT_THAT(problems_in("name = \"\xff\xfe\"\n"), ElementsAre(StartsWith("bad.toml:1:")));
}

TEST(PackingFileErrors, AreReportedWithThoseOfTheScene) {
    const TestFolder folder;
    folder.write("bad.csv", "x_m,y_m,z_m,diameter_m\n0.05,0.05,low,0.02\n0.05,0.05,0.05,-0.02\n");
    const auto scene = folder.write("scene.toml", "[packing]\nfile = \"bad.csv\"\n[grains]\nfriction = -1\n");
    const auto problems = problems_of([&] { read_scene(scene); });
    EXPECT_THAT(problems,
                ElementsAre(HasSubstr("bad.csv:2: z must be a finite number [m], got \"low\""),
                            HasSubstr("bad.csv:3: diameter must be a finite number > 0 [m], got \"-0.02\""),
                            AllOf(HasSubstr("scene.toml:4: "), HasSubstr("got -1"))));
}

TEST(PackingFileErrors, GeneratedGrainsWithAFileAreRefused) {
    const TestFolder folder;
    folder.write("one.csv", "x_m,y_m,z_m,diameter_m\n0.05,0.05,0.05,0.02\n");
    const auto both = folder.write("both.toml", "[packing]\nfile = \"one.csv\"\ncount = 4\n");
    EXPECT_THAT(
        problems_of([&] { read_scene(both); }),
        ElementsAre(HasSubstr("both.toml:3: packing.count must be left out where packing.file is given")));
    EXPECT_THAT(problems_of([&] {
                    parse_scene("", "a.toml",
                                {"packing.count=400", "packing.file=" + (folder.path / "one.csv").string()});
                }),
                ElementsAre(HasSubstr("--set packing.count: packing.count must be left out")));
}

TEST(PackingFileErrors, ANarrowCylinderIsNamedWithTheFile) {
    const TestFolder folder;
    folder.write("one.csv", "x_m,y_m,z_m,diameter_m\n0.012,0.012,0.05,0.02\n");
    const auto narrow = folder.write(
        "narrow.toml", "[packing]\nfile = \"one.csv\"\n[container]\nshape = \"cylinder\"\nradius = 0.012\n");
    EXPECT_THAT(problems_of([&] { read_scene(narrow); }),
                ElementsAre(testing::AllOf(
                    HasSubstr("one.csv: container.radius must be at least the largest diameter"),
                    testing::EndsWith("in a narrower cylinder"))));
}

TEST(PackingFileErrors, IdenticalCopiesAreRefused) {
    const TestFolder folder;
    folder.write("one.csv", "x_m,y_m,z_m,diameter_m\n0.05,0.05,0.05,0.02\n");
    const std::string text = "[packing]\nfile = \"one.csv\"\n[batch]\nreplicas = 2\n";
    const auto alike = folder.write("alike.toml", text);
    EXPECT_THAT(problems_of([&] { read_scene(alike); }),
                ElementsAre(HasSubstr("alike.toml:4: batch.replicas must be 1 where packing.file")));
    EXPECT_EQ(read_scene(alike, {"packing.position_jitter=1e-5"}).replicas.size(), 2u);
    EXPECT_THAT(problems_of([&] { read_scene(alike, {"packing.position_jitter=0.01"}); }),
                ElementsAre(HasSubstr("at most a tenth of the smallest diameter 0.02")));
}

TEST(SceneFileErrors, AreDistinguished) {
    const TestFolder folder;
    EXPECT_THAT(problems_of([&] { read_scene(folder.path / "none.toml"); }),
                ElementsAre(HasSubstr("got no such file")));
    EXPECT_THAT(problems_of([&] { read_scene(folder.path); }), ElementsAre(HasSubstr("not a file")));
}

TEST(HostileScenes, AreRefusedWithPlainMessages) {
    EXPECT_THAT(problems_in(std::string(2 << 20, ' ')),
                ElementsAre(HasSubstr("must be at most 1048576 bytes")));
    EXPECT_THAT(problems_in(std::string(100000, '[')), ElementsAre(HasSubstr("must be TOML")));
    std::string many;
    for (int i = 0; i < 20000; ++i) many += "key" + std::to_string(i) + " = 1\n";
    EXPECT_THAT(problems_in(many), SizeIs(101)) << "a hundred, and how many more";
    EXPECT_LT(problems_in("\"" + std::string(500000, 'k') + "\" = 1").at(0).size(), 300u);
    std::string variations = "[batch.vary]\n";
    for (const char* key : {"grains.friction", "walls.friction", "contact.gamma", "grains.drag"}) {
        variations.append("\"").append(key).append("\" = [");
        for (int i = 0; i < 5000; ++i) variations += std::to_string(i) + "e-4,";
        variations += "]\n";
    }
    EXPECT_THAT(problems_in(variations),
                ElementsAre(HasSubstr("at most 10000 replicas in all, got 6.25e+14")));
}

/// `part` as often as 100 parts of a name, or 100 tables inside each other, and more often.
std::string repeated(int times, const std::string& part, const std::string& between = ".") {
    std::string all = part;
    for (int i = 1; i < times; ++i) all += between + part;
    return all;
}

TEST(HostileScenes, DeepNamesAreRefusedBeforeTheyAreParsed) {
    const auto too_deep = ElementsAre(HasSubstr("names must have at most 100 parts"));
    for (const int times : {102, 5'000, 40'000, 160'000}) {
        for (const std::string part : {"a", "0", "\"a.b\"", "'a'", " a ", "\"\""}) {
            const std::string name = repeated(times, part);
            EXPECT_THAT(problems_in(name + " = 1"), too_deep);
            EXPECT_THAT(problems_in("[" + name + "]\nb = 1"), too_deep);
            EXPECT_THAT(problems_in("[[" + name + "]]\nb = 1"), too_deep);
            EXPECT_THAT(problems_in("a = {" + name + " = 1}"), too_deep);
            EXPECT_THAT(problems_in("a = [\n1.5, # [ \"\n{b = 2.5, " + name + " = 1}]"), too_deep);
            EXPECT_THAT(problems_in("", {"grains={" + name + "=1}"}), SizeIs(1));
            EXPECT_THAT(problems_in("", {name + "=1"}), SizeIs(1));
            EXPECT_THAT(problems_in("a = \"\"\"\\\"\"\"\"\"\"\n" + name + " = 1"), too_deep)
                << "after a text";
        }
    }
    // 51 names of three parts inside each other.
    EXPECT_THAT(problems_in("a.a.a = " + repeated(50, "{a.a.a", " = ") + " = 1" + std::string(50, '}')),
                too_deep);
    EXPECT_THAT(
        problems_in("a = [" + repeated(120, "1.5", ", ") + "]\n" + repeated(300, "[a]\nb = 1.5", "\n")),
        ElementsAre(testing::Not(HasSubstr("100 parts"))))
        << "long, not deep";
}

TEST(HostileScenes, NamesOfHundredPartsAreRead) {
    EXPECT_THAT(problems_in(repeated(100, "a") + " = 1"),
                ElementsAre(HasSubstr("must be a table of a scene")));
}

}  // namespace
}  // namespace mcdem
