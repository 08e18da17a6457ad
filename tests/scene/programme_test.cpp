// Programmes in scenes: stages and their legs, overrides, variations, errors.
#include <cmath>

#include "scene/programme/legs.h"
#include "scene/programme/programme_text.h"
#include "scene/read/keys.h"
#include "scene/read/read_scene.h"
#include "scene_test_tools.h"

namespace mcdem {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string box_text =
    "[box]\nsize_x = 0.08\nsize_y = 0.08\n[packing]\ncount = 60\npacking_fraction = 0.55\n"
    "[plate]\nstart = 0.09\nend = 0.06\n";

Scene read(const std::string& stages, const std::vector<std::string>& overrides = {}) {
    return parse_scene(box_text + stages, "programme.toml", overrides);
}

std::vector<Leg> legs_in(const std::string& stages) {
    const Replica replica = read(stages).replicas.front();
    return legs_of(stages_of(replica), replica.plate);
}

std::vector<double> targets(const std::vector<Leg>& legs) {
    std::vector<double> all;
    for (const Leg& leg : legs) all.push_back(leg.target);
    return all;
}

TEST(Programme, HasMovesHoldsCyclesAndRepeats) {
    const auto legs = legs_in(R"([[programme]]
position = 0.08
[[programme]]
strain = 0.25
[[programme]]
stage = "hold"
time = 2
[[programme]]
stage = "cycle"
force = 1.5
back = 0.5
cycles = 2
growth = 0.25
[[programme]]
stage = "repeat"
stages = 2
times = 3
)");
    const auto at = targets(legs);
    ASSERT_EQ(legs.size(), 3u + 4 + 2 * 5);
    EXPECT_EQ(at[0], 0.08);
    EXPECT_NEAR(at[1], 0.09 * 0.75, 1e-15);
    EXPECT_TRUE(std::isnan(at[2]));
    EXPECT_EQ(std::vector<double>(at.begin() + 3, at.begin() + 7),
              (std::vector<double>{1.5, 0.5, 1.75, 0.5}));
    for (std::size_t again = 0; again < 2; ++again)
        for (std::size_t k = 0; k < 5; ++k) {
            EXPECT_EQ(legs[7 + 5 * again + k].stage, legs[2 + k].stage);
            if (k > 0) {
                EXPECT_EQ(at[7 + 5 * again + k], at[2 + k]);
            }
        }
    EXPECT_EQ(leg_count(read("[[programme]]\nstrain = 0.1\n[[programme]]\nstage = \"repeat\"\nstages = 1\n"
                             "[[programme]]\nstage = \"repeat\"\nstages = 2\ntimes = 4\n")
                            .replicas[0]
                            .programme),
              2 * 4)
        << "a repeat of a repeat";
}

TEST(Programme, OfPlateAndProtocolIsOneCycle) {
    const Replica replica = read("[protocol]\ncycles = 3\nscans_per_stroke = 7\n").replicas.front();
    EXPECT_THAT(replica.programme, IsEmpty());
    const auto stages = stages_of(replica);
    EXPECT_THAT(targets(legs_of(stages, replica.plate)), ElementsAre(0.06, 0.09, 0.06, 0.09, 0.06, 0.09));
    EXPECT_EQ(scan_count(stages), 42);
    EXPECT_FALSE(replica.parameters.contains("programme.1.stage"));
}

const std::string two_stages =
    "[[programme]]\nforce = 1\nscans = 2\n[[programme]]\nstage = \"hold\"\nkeep = \"force\"\ntime = 0.5\n";

TEST(Programme, StagesAreOverriddenAndVariedSeparately) {
    const Scene scene = read(
        "[[programme]]\nscans = 2\n[[programme]]\nstage = \"hold\"\nkeep = \"force\"\n"
        "[batch.vary]\n\"programme.1.force\" = [0.5, 2]\nprogramme.2.time = [1, 3]\n",
        {"programme.1.speed=0.01"});
    ASSERT_EQ(scene.replicas.size(), 4u);
    EXPECT_EQ(scene.replicas[1].programme[0].force, 0.5);
    EXPECT_EQ(scene.replicas[1].programme[1].time, 3);
    EXPECT_EQ(scene.replicas[2].programme[0].force, 2);
    EXPECT_EQ(scene.replicas[2].programme[0].speed, 0.01);
    EXPECT_EQ(scene.replicas[1].label, "force=0.5, time=3");
    EXPECT_EQ(parameter_text(scene.replicas[1].parameters.at("programme.1.force")), "0.5");
    EXPECT_EQ(parameter_text(scene.replicas[1].parameters.at("programme.1.position")), "");
    const Scene again = parse_scene(scene.text, "programme.toml");
    ASSERT_EQ(again.replicas.size(), 4u);
    for (const auto& [key, value] : scene.replicas[3].parameters)
        EXPECT_EQ(again.replicas[3].parameters.at(key), value) << key << "\n" << scene.text;
}

TEST(Programme, AnOverrideRemovesConflictingKeys) {
    const Stage stage = read(two_stages, {"programme.1.strain=0.1", "programme.1.scan_at=[0.05, 0.1]"})
                            .replicas[0]
                            .programme[0];
    EXPECT_TRUE(std::isnan(stage.force));
    EXPECT_EQ(stage.strain, 0.1);
    EXPECT_THAT(stage.scan_at, ElementsAre(0.05, 0.1));
    const auto other = read(two_stages, {"programme=[{strain = 0.2}]"}).replicas[0].programme;
    ASSERT_EQ(other.size(), 1u);
    EXPECT_EQ(other[0].strain, 0.2);
}

TEST(Programme, OfADamagedFileIsRefused) {
    const auto programme =
        read("[[programme]]\nforce = 1\n[[programme]]\nstage = \"repeat\"\n").replicas.front().programme;
    auto parameters = programme_parameters(programme);
    EXPECT_EQ(programme_of(parameters).size(), 2u);
    parameters["programme.2.stages"] = std::int64_t{100};
    EXPECT_THAT(
        problems_of([&] { programme_of(parameters); }),
        ElementsAre(HasSubstr("programme.2.stages: must be at most the 1 stages before it, got 100")));
    parameters = programme_parameters(programme);
    parameters["programme.1.scans"] = parameters["programme.2.times"] = std::int64_t{10000};
    EXPECT_THAT(problems_of([&] { programme_of(parameters); }), ElementsAre(HasSubstr("and 1000000 scans")));
}

// Files that other programs wrote or changed.
TEST(Programme, ParametersOfOtherSpellingsAreNumbers) {
    EXPECT_EQ(parameters_of({{"grains.friction", "+0.05"}, {"protocol.cycles", "10.0"}}),
              (Parameters{{"grains.friction", 0.05}, {"protocol.cycles", std::int64_t{10}}}));
    for (const char* text : {"nan", "inf", "0.1 m", "[1]"})
        EXPECT_EQ(parameters_of({{"grains.friction", text}}).begin()->second, Parameter(text)) << text;
    for (const char* text : {"[0.1, nan]", "[0.1, \"a\"]"})
        EXPECT_EQ(parameters_of({{"programme.1.scan_at", text}}).begin()->second, Parameter(text)) << text;
    // Keys of another version.
    EXPECT_EQ(
        parameters_of({{"seed", "3"}, {"old.switch", "true"}, {"old.size", "0.5"}, {"old.word", "a b"}}),
        (Parameters{
            {"seed", std::uint64_t{3}}, {"old.switch", true}, {"old.size", 0.5}, {"old.word", "a b"}}));
}

TEST(Programme, ParametersAreTheSameFromTheirTexts) {
    const Scene scene = read("[[programme]]\nposition = 0.07\nscan_at = [0.085, 0.08]\n");
    const Parameters& parameters = scene.replicas.front().parameters;
    EXPECT_EQ(parameters_of(parameter_texts(parameters)), parameters);
    EXPECT_EQ(parameters.at("programme.1.scan_at"), Parameter(std::vector{0.085, 0.08}));
    EXPECT_EQ(parameters.at("packing.seed"), Parameter(std::uint64_t{1}));
    // As written by an earlier version, damaged, and of a key that is gone.
    const ParameterTexts others{
        {"contact.model", "\"mc_dem\""}, {"grains.friction", "1/2"}, {"packing.count", "3.5"}, {"old", "7"}};
    EXPECT_EQ(parameters_of(others), (Parameters{{"contact.model", "mc_dem"},
                                                 {"grains.friction", "1/2"},
                                                 {"packing.count", "3.5"},
                                                 {"old", std::uint64_t{7}}}));
    std::string nested = "1\na";
    for (int depth = 0; depth < 300'000; ++depth) nested += ".a";
    EXPECT_EQ(parameters_of({{"programme.1.scan_at", nested + " = 1"}}).begin()->second,
              Parameter(nested + " = 1"));
}

}  // namespace
}  // namespace mcdem
