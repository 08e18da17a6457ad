// A recorded run used as a packing.

#include "io/run_packing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"
#include "io/results.h"
#include "io/synthetic_run.h"

namespace mcdem::test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(RunPacking, IsTheFirstFrameOrTheGivenOne) {
    const TestFolder folder;
    const auto run = synthetic_run({1, 27, 6});
    write_run(folder / "run.h5", run);
    const Recording& recording = run.recordings.front();
    EXPECT_EQ(recorded_packing(folder / "run.h5", {}).position, recording.scans[0].position);
    EXPECT_EQ(read_packing_or_run(folder / "run.h5", {}).diameter, recording.diameter);
    EXPECT_EQ(recorded_packing(folder / "run.h5", recording.scans[3].frame).position,
              recording.scans[3].position);
    const auto box = recorded_packing(folder / "run.h5", recording.scans[3].frame).box;
    ASSERT_TRUE(box);
    EXPECT_EQ(box->shape, recording.box.shape);
    EXPECT_EQ(box->size, Vec3(recording.box.size_x, recording.box.size_y, recording.scans[3].plate_z));
    EXPECT_THAT([&] { recorded_packing(folder / "run.h5", 99); },
                ThrowsMessage<InputError>(HasSubstr("must hold positions of frame 99")));
    write_run(folder / "two.h5", synthetic_run({2, 27, 6}));
    EXPECT_THAT([&] { recorded_packing(folder / "two.h5", {}); },
                ThrowsMessage<InputError>(HasSubstr("must hold one replica where it is a packing, got 2")));
}

}  // namespace
}  // namespace mcdem::test
