// The kernels' program with one more kernel, that a test has written.
#pragma once
#include <fmt/format.h>

#include "cl/kernel.h"
#include "reference/test_scene.h"

namespace reference {

/// In single precision.
inline cl::Program with_kernel(const std::string& text, const KernelBuild& kernels) {
    cl::Program program(device().context(), mcdem::program_text() + text);
    program.build(
        {device().handle()},
        fmt::format("-w -cl-std=CL1.2 -DMCDEM_DOUBLE=0 -DLANES={} -DSLOTS={} -DBLOCK={} -DLIST_ITEMS=16",
                    kernels.lanes, kernels.slots, kernels.block())
            .c_str());
    return program;
}

}  // namespace reference
