#include "metrics/replicas.h"

#include <gtest/gtest.h>

#include "metrics/synthetic.h"

namespace mcdem {
namespace {

TEST(GroupBySetting, seeds_are_replicas_models_are_settings) {
    auto run = synthetic::run({{.model = "independent"}, {.model = "mc_dem"}}, 3);
    std::swap(run.recordings[1], run.recordings[4]);  // replicas of a setting need not be adjacent
    const auto settings = group_by_setting(run);
    ASSERT_EQ(settings.size(), 2u);
    EXPECT_EQ(settings[0].label, "independent");
    EXPECT_EQ(settings[1].label, "mc_dem");
    EXPECT_EQ(seeds_of(settings[0].replicas), (std::vector<std::string>{"1", "3", "2"}));
    EXPECT_EQ(model_of(settings[1].replicas), ContactModel::mc_dem);
}

TEST(GroupBySetting, label_contains_what_differs) {
    auto run = synthetic::run({{.model = "mc_dem"}}, 4);
    for (int i = 0; i < 4; ++i) run.recordings[i].parameters["contact.gamma"] = i < 2 ? "1" : "1.125";
    const auto settings = group_by_setting(run);
    ASSERT_EQ(settings.size(), 2u);
    EXPECT_EQ(settings[0].label, "gamma=1");
    EXPECT_EQ(settings[1].label, "gamma=1.125");
    EXPECT_EQ(settings[1].replicas.size(), 2u);
}

TEST(GroupBySetting, uses_the_labels_of_the_scene) {
    auto run = synthetic::run({{.model = "mc_dem"}}, 4);
    for (int i = 0; i < 4; ++i) {
        run.recordings[i].parameters["contact.gamma"] = i < 2 ? "1" : "1.125";
        run.recordings[i].label = std::string(i < 2 ? "packing 7" : "gamma=1.125") + (i % 2 ? " #2" : " #1");
    }
    const auto settings = group_by_setting(run);
    EXPECT_EQ(settings[0].label, "packing 7");
    EXPECT_EQ(settings[1].label, "gamma=1.125");
    run.recordings[3].label = "packing 7 #4";  // no longer distinct
    EXPECT_EQ(group_by_setting(run)[1].label, "gamma=1.125");
    EXPECT_EQ(group_by_setting(run)[0].label, "gamma=1");
}

TEST(GroupBySetting, quoted_words_are_equal_to_unquoted_ones) {
    auto run = synthetic::run({{.model = "\"independent\""}, {.model = "\"mc_dem\""}}, 1);
    EXPECT_EQ(group_by_setting(run)[0].label, "independent");
    EXPECT_EQ(model_of(group_by_setting(run)[1].replicas), ContactModel::mc_dem);
}

TEST(GroupBySetting, a_single_setting_is_named_by_its_model_or_its_run) {
    auto run = synthetic::run({{}}, 2);
    EXPECT_EQ(group_by_setting(run)[0].label, "mc_dem");
    for (auto& recording : run.recordings) recording.parameters.clear();
    EXPECT_EQ(group_by_setting(run)[0].label, "synthetic");
    EXPECT_FALSE(model_of(group_by_setting(run)[0].replicas));
}

TEST(DiscardOf, reads_the_scene_key) {
    Recording recording;
    EXPECT_EQ(discard_of(recording), 0);
    recording.parameters.insert_or_assign("protocol.discard", "5");
    EXPECT_EQ(discard_of(recording), 5);
    recording.parameters.insert_or_assign("protocol.discard", "-3");
    EXPECT_EQ(discard_of(recording), 0);
}

}  // namespace
}  // namespace mcdem
