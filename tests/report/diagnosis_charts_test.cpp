#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/diagnosis/diagnosis_page.h"
#include "report/diagnosis/diagnosis_values.h"
#include "report/diagnosis/diagnosis_words.h"
#include "report/diagnosis_samples.h"

namespace mcdem {
namespace {

std::vector<std::string> names_of(const std::vector<Chart>& charts) {
    std::vector<std::string> names;
    for (const auto& chart : charts) names.push_back(chart.name);
    return names;
}

TEST(DiagnosisCharts, have_the_values_of_the_printed_figures) {
    const auto d = samples::diagnosis(Verdict::effect);
    const auto charts = diagnosis_charts(d);
    ASSERT_THAT(names_of(charts), testing::ElementsAre("where", "which", "how_far", "gap_left"));
    auto values = diagnosis_figure_values(d);
    EXPECT_EQ(charts[0].values, values["where"]);
    EXPECT_EQ(charts[1].values["rows"][0]["explained"], percent(d.ranking[0].explained));
    EXPECT_EQ(charts[1].values["rows"][0]["gain"], d.ranking[0].score);
    EXPECT_EQ(charts[2].values, values["how_far"]["forces"]);
    EXPECT_EQ(charts[3].values["bars"], values["how_far"]["bars"]);
    EXPECT_THAT(charts[0].caption, testing::HasSubstr("Framed: beyond"));
    EXPECT_THAT(charts[3].caption, testing::HasSubstr(d.gap_reduction->held_out));
}

TEST(DiagnosisCharts, exist_only_with_data) {
    EXPECT_TRUE(diagnosis_charts({}).empty());
    auto d = samples::diagnosis(Verdict::effect);
    d.gap_reduction->top_force.clear();
    EXPECT_THAT(names_of(diagnosis_charts(d)), testing::ElementsAre("where", "which", "gap_left"));
    d.gap_reduction->before = 0;
    EXPECT_THAT(names_of(diagnosis_charts(d)), testing::ElementsAre("where", "which"));
}

}  // namespace
}  // namespace mcdem
