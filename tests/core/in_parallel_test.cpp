#include "core/in_parallel.h"

#include <gtest/gtest.h>

namespace mcdem {
namespace {

TEST(InParallel, DoesEveryPieceOnce) {
    for (const std::size_t count : {0, 1, 2, 1000}) {
        std::vector<int> times(count, 0);
        in_parallel(count, [&](std::size_t i) { ++times[i]; });
        EXPECT_EQ(times, std::vector<int>(count, 1));
    }
}

}  // namespace
}  // namespace mcdem
