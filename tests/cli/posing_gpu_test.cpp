// A CPU that emulates a GPU (tests/layers/gpu_layer.cpp): messages for users. Its results are tested by
// test_kernels.
#include "cli/cli_test.h"

namespace mcdem {
namespace {

using testing::HasSubstr;

using PosingGpuTest = CliTest;

TEST_F(PosingGpuTest, IsListedAsAGpu) {
    const auto devices = mcdem({"devices"}, {"OPENCL_LAYERS=" MCDEM_GPU_LAYER});
    expect_done(devices);
    EXPECT_THAT(devices.out, HasSubstr("GPU"));
}

TEST_F(PosingGpuTest, AKernelWithTooFewRegistersIsRefusedWithARemedy) {
    const auto refused = mcdem(run_words("a", {"--set", "numerics.slots=64"}),
                               {"OPENCL_LAYERS=" MCDEM_GPU_LAYER, "MCDEM_TEST_KERNEL_GROUP=128"});
    EXPECT_EQ(refused.exit_code, 2) << refused.err;
    EXPECT_THAT(refused.err, HasSubstr("advance needs 256 work-items"));
    EXPECT_THAT(refused.err, HasSubstr("lower numerics.slots"));
    EXPECT_THAT(refused.err, HasSubstr("numerics.precision"));
}

TEST_F(PosingGpuTest, SmallWorkGroupsUseFewerGrains) {
    const auto done = mcdem(run_words("a", {"--set", "protocol.scans_per_stroke=1"}),
                            {"OPENCL_LAYERS=" MCDEM_GPU_LAYER, "MCDEM_TEST_GROUP=64"});
    expect_done(done);
}

}  // namespace
}  // namespace mcdem
