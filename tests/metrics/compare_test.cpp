#include "metrics/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"
#include "metrics/synthetic.h"

namespace mcdem {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(Compare, with_itself_is_a_perfect_fit) {
    const auto run = synthetic::run({{.cycles = 2, .scatter = 0.05, .contacts = 500}}, 4);
    const auto c = compare(group_by_setting(run)[0], replicas_of(run.recordings));
    EXPECT_DOUBLE_EQ(c.Rtop.value, 1);
    EXPECT_NEAR(c.Rtop.standard_error, 0, 1e-12);  // paired by seed
    EXPECT_EQ(c.errf.value, 0);
    EXPECT_EQ(c.errZ.value, 0);
    EXPECT_LT(c.bhat.value, 1e-3);
    EXPECT_EQ(c.levels_errf, 20);
    EXPECT_EQ(c.replicas, 4);
    EXPECT_THAT(c.notes, IsEmpty());
}

TEST(Compare, with_known_results) {
    const auto simulated = synthetic::run({{.top = 6, .hysteresis = 0, .touch = 0}}, 2);
    const auto measured = synthetic::recording({.top = 15, .hysteresis = 0, .touch = 0});
    const auto c = compare(group_by_setting(simulated)[0], {&measured});
    EXPECT_NEAR(c.Rtop.value, 0.4, 1e-12);
    // 9 N (i/10)^(3/2) at i = 1 .. 10 and 9 .. 0: mean square 81 (2 * 2025 + 1000) / 1000 / 20
    EXPECT_NEAR(c.errf.value, std::sqrt(81 * (2 * 2025 + 1000) / 1000.0 / 20), 1e-12);
}

TEST(Compare, standard_error_of_rtop_is_the_scatter_of_replicas) {
    const auto simulated = synthetic::run({{.scatter = 0.05}}, 32);
    const auto measured = synthetic::recording({});
    const auto c = compare(group_by_setting(simulated)[0], {&measured});
    EXPECT_NEAR(c.Rtop.standard_error, 0.05 / std::sqrt(32.0), 0.004);
    EXPECT_GT(c.errf.standard_error, 0);
}

TEST(Compare, lists_missing_quantities) {
    auto run = synthetic::run({{.levels = 7}}, 2);
    run.recordings[1].failure = Failure{4711, 42, "overlap past the limit"};
    run.recordings[1].scans.resize(3);
    auto measured = synthetic::recording({});
    const auto c = compare(group_by_setting(run)[0], {&measured});
    EXPECT_THAT(c.notes, Contains(HasSubstr("1 of 2 replicas stopped early")));
    EXPECT_THAT(c.notes, Contains(HasSubstr("step 4711, grain 42: overlap past the limit")));
    EXPECT_THAT(c.notes, Contains(HasSubstr("16 of 20 levels of the reference lie between")));
    EXPECT_THAT(c.notes, Contains(HasSubstr("2 of 20 levels of the reference are outside")));
    EXPECT_THAT(c.notes, Contains(HasSubstr("errZ is without threshold")));
    EXPECT_THAT(c.notes, Contains(HasSubstr("bhat: contacts are not recorded")));
    EXPECT_FALSE(c.bhat.available());
    EXPECT_TRUE(c.Rtop.available());
}

TEST(Compare, discarding_all_cycles_is_an_error) {
    auto run = synthetic::run({{}}, 1);
    auto measured = synthetic::recording({.cycles = 2});
    run.recordings[0].parameters["protocol.discard"] = measured.parameters["protocol.discard"] = "1";
    EXPECT_THROW(compare(group_by_setting(run)[0], {&run.recordings[0]}), InputError);
    EXPECT_THAT(compare(group_by_setting(run)[0], {&measured}).notes,
                Contains(HasSubstr("no scans after the discarded cycles")));
}

}  // namespace
}  // namespace mcdem
