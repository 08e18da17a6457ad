// A violated invariant is a defect that names its place.
#include "core/expects.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace mcdem {
namespace {

TEST(Expects, NamesWhatMustHoldAndWhere) {
    EXPECT_NO_THROW(expects(true, "all is well"));
    EXPECT_THAT([] { expects(1 > 2, "one is more than two"); },
                testing::ThrowsMessage<std::logic_error>(
                    testing::MatchesRegex(".*expects_test.cpp:[0-9]+: one is more than two")));
}

}  // namespace
}  // namespace mcdem
