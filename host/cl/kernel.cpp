#include "cl/kernel.h"

namespace mcdem::inline opencl {

void expect_launchable(const Device& device, const cl::Kernel& kernel, int work_items) {
    const auto name = kernel.getInfo<CL_KERNEL_FUNCTION_NAME>();
    const auto expect = [&](const char* what, std::size_t needed, std::size_t there) {
        if (needed > there)
            throw InputError(
                fmt::format("the kernel {} needs {} {}, and {} has {} for it: lower numerics.slots, or take "
                            "numerics.precision = \"float\", or another device (--device)",
                            name, needed, what, device.info().name, there));
    };
    expect("work-items in a work-group", work_items,
           kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device.handle()));
    expect("bytes of local memory", kernel.getWorkGroupInfo<CL_KERNEL_LOCAL_MEM_SIZE>(device.handle()),
           device.handle().getInfo<CL_DEVICE_LOCAL_MEM_SIZE>());
}

}  // namespace mcdem::opencl
