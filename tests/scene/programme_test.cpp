// Programmes in scenes: stages and their legs, overrides, variations, errors.
#include <cmath>

#include "scene/programme/legs.h"
#include "scene/programme/programme_text.h"
#include "scene/read/read_scene.h"
#include "scene_test_tools.h"

namespace mcdem {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string box_text =
    "[box]\nsize_x = 0.08\nsize_y = 0.08\n[packing]\ncount = 60\npacking_fraction = 0.55\n"
    "[plate]\nstart = 0.09\nend = 0.06\n";

Scene read(const std::string& stages, const std::vector<std::string>& overrides = {}) {
    return parse_scene(box_text + stages, "programme.toml", overrides);
}

std::vector<std::string> problems_of_stages(const std::string& stages,
                                            const std::vector<std::string>& overrides = {}) {
    return problems_of([&] { read(stages, overrides); });
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
    EXPECT_EQ(scene.replicas[1].parameters.at("programme.1.force"), "0.5");
    EXPECT_EQ(scene.replicas[1].parameters.at("programme.1.position"), "");
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

struct Wrong {
    const char* stage;
    const char* told;
};

TEST(Programme, ErrorsAreReportedWithARemedy) {
    const Wrong all[] = {
        {"forse = 1",
         "programme.1.forse must be a key of a scene, got an unknown one (did you mean programme.1.force?)"},
        {"scans = 2", "programme.1.position must be given, or strain or force: a move needs one of them"},
        {"force = 1\nstrain = 0.1", "programme.1.force must be left out where strain is given"},
        {"force = -1", "programme.1.force must be a number > 0 and <= 1e+09 [N], got -1"},
        {"force = 1e6", "programme.1.force must be one that the grains can bear, got 1000000: beyond some"},
        {"position = 0.1",
         "programme.1.position must keep the plate between plate.end = 0.06 and plate.start = 0.09, got 0.1"},
        {"strain = 0.5",
         "programme.1.strain must keep the plate between plate.end = 0.06 and plate.start = 0.09, got 0.5, "
         "that is 0.045 m"},
        {"strain = 0.1\ntime = 3", "programme.1.time must be left out of a stage that is a move"},
        {"strain = 0.1\nscans = 2\nscan_at = [0.1]",
         "programme.1.scan_at must be left out where scans is given"},
        {"strain = 0.1\nscan_at = [0.05, 0.02]",
         "programme.1.scan_at must be places on the way to strain = 0.1"},
        {"strain = 0.1\nscan_at = []", "programme.1.scan_at must be a list of numbers, got an empty list"},
        {"strain = 0.1\nscans = 0",
         "programme.1.scans and the others must leave 1 to 1000000 scans in all, got 0"},
        {"stage = \"hold\"", "programme.1.time must be given: a hold has no other end"},
        {"stage = \"hold\"\nkeep = \"force\"\ntime = 1",
         "programme.1.keep must be position in the first stage"},
        {"stage = \"hold\"\ntime = 1\nscan_at = [0.5, 2]",
         "programme.1.scan_at must be growing times > 0 and <= time = 1, got 2 after 0.5"},
        {"stage = \"cycle\"\nforce = 1", "programme.1.back must be given: the force that a cycle returns to"},
        {"stage = \"cycle\"\nforce = 1\nback = 1", "programme.1.back must differ from force, got 1 for both"},
        {"stage = \"cycle\"\nforce = 1\nback = 0", "programme.1.back must be a force > 0 [N], got 0"},
        {"stage = \"cycle\"\nstrain = 0.1\nback = 0\ncycles = 9\ngrowth = 1",
         "programme.1.growth must keep the plate between plate.end"},
        {"stage = \"cycle\"\nstrain = 0.1\nback = 0\ncycles = 9\ngrowth = -0.2",
         "programme.1.growth must leave the last of 9 cycles an amplitude, got -0.2"},
        {"stage = \"repeat\"", "programme.1.stages must be at most the 0 before it, got 1"},
        {"stage = \"wait\"", "programme.1.stage must be one of move, hold, cycle, repeat, got \"wait\""},
        {"", "programme.1 must say what the plate does, got nothing"},
        {"strain = 0.1\n[protocol]\ncycles = 3",
         "protocol.cycles must be left out where a programme is given"},
        {"strain = 0.1\n[batch.vary]\n\"programme.1.stage\" = [\"hold\"]",
         "must be a key of which replicas have their own"},
        {"strain = 0.1\n[batch.vary]\n\"programme.3.force\" = [1]",
         "programme.2.stage must be given too: there is a stage 3"},
        {"strain = 0.1\n[[programme]]\nstage = \"cycle\"\nstrain = 0.1\nback = 0\ncycles = "
         "10000\n[[programme]]\nstage = \"repeat\"\ntimes = 100",
         "programme.1.stage and the others must be at most 100000 moves and holds in all"},
    };
    for (const Wrong& wrong : all)
        EXPECT_THAT(problems_of_stages("[[programme]]\n" + std::string(wrong.stage) + "\n"),
                    Contains(HasSubstr(wrong.told)))
            << wrong.stage;
    EXPECT_THAT(problems_of_stages("programme = 3\n"), Contains(HasSubstr("programme")));
    EXPECT_THAT(
        problems_of([] { parse_scene("programme = []\n" + box_text, "p.toml"); }),
        Contains(HasSubstr(
            "p.toml:1: programme must be a list of 1 to 100 stages ([[programme]]), got an empty list")));
    EXPECT_THAT(problems_of_stages("[programme]\nstrain = 0.1\n"),
                Contains(HasSubstr(
                    "programme.strain must be below a header in double brackets, [[programme]], one for "
                    "each of its stages")));
    EXPECT_THAT(problems_of_stages("[[programme]]\nstrain = 0.1\n[[programme]]\nscans = 1\n"),
                Contains(HasSubstr("programme.toml:13: programme.2.position")))
        << "the place of the stage";
}

TEST(Programme, ProblemsOfAStageAreReportedOnce) {
    EXPECT_THAT(problems_of_stages("[[programme]]\nforce = 1\nback = 2\n[batch.vary]\n\"contact.model\" = "
                                   "[\"independent\", \"mc_dem\"]\n"),
                ElementsAre(HasSubstr(
                    "programme.toml:12: programme.1.back must be left out of a stage that is a move")));
}

TEST(Programme, OfADamagedFileIsRefused) {
    const auto programme =
        read("[[programme]]\nforce = 1\n[[programme]]\nstage = \"repeat\"\n").replicas.front().programme;
    auto parameters = programme_parameters(programme);
    EXPECT_EQ(programme_of(parameters).size(), 2u);
    parameters["programme.2.stages"] = "100";
    EXPECT_THAT(
        problems_of([&] { programme_of(parameters); }),
        ElementsAre(HasSubstr("programme.2.stages: must be at most the 1 stages before it, got 100")));
    parameters = programme_parameters(programme);
    parameters["programme.1.scans"] = parameters["programme.2.times"] = "10000";
    EXPECT_THAT(problems_of([&] { programme_of(parameters); }), ElementsAre(HasSubstr("and 1000000 scans")));
    std::string nested = "1\na";
    for (int depth = 0; depth < 300'000; ++depth) nested += ".a";
    parameters = programme_parameters(programme);
    parameters["programme.1.speed"] = nested + " = 1";
    EXPECT_EQ(programme_of(parameters).size(), 2u);
}

}  // namespace
}  // namespace mcdem
