#include "core/in_parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

namespace mcdem {
namespace {

TEST(InParallel, ProcessesEveryPieceOnce) {
    for (const std::size_t count : {0, 1, 2, 1000}) {
        std::vector<int> times(count, 0);
        in_parallel(count, [&](std::size_t i) { ++times[i]; });
        EXPECT_EQ(times, std::vector<int>(count, 1));
    }
}

TEST(InParallel, RethrowsExceptionsOfPieces) {
    std::atomic<int> begun{0};
    const auto work = [&](std::size_t i) {
        ++begun;
        if (i == 3) throw std::runtime_error("piece 3");
    };
    EXPECT_THROW(in_parallel(100000, work), std::runtime_error);
    EXPECT_GE(begun, 4);
}

}  // namespace
}  // namespace mcdem
