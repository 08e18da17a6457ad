// The kernels as one OpenCL program for one build, from the text in the program or from the folder that
// the environment variable MCDEM_KERNELS names.
#pragma once
#include <algorithm>

#include "cl/device.h"
#include "core/names.h"

namespace mcdem::inline opencl {

/// What distinguishes one build of the kernels from another.
struct KernelBuild {
    Precision precision = Precision::single_precision;
    int slots = 16;   ///< neighbour slots a grain, a multiple of 16
    int lanes = 16;   ///< 16: a work-item a grain (CPU); 1: a work-item a slot (GPU)
    int species = 1;  ///< materials that a replica can have: 1 or MAX_SPECIES of kernels/material.h
    int group = 256;  ///< work-items a work-group has at most; every GPU known takes 256

    /// Grains a block: what a work-group of a step works for.
    int block() const { return std::clamp(lanes == 16 ? group : group / slots, 1, 16); }
    /// Of a work-group of a step.
    int work_items() const { return lanes == 16 ? block() : block() * slots; }
    /// Of a work-group of the kernels that list neighbours, a work-item a grain.
    int list_items() const { return lanes == 16 ? block() : std::min(group, 64); }
    std::size_t real_size() const { return precision == Precision::double_precision ? 8 : 4; }
};

/// The build that suits `device`: vectors of contacts on a CPU, a work-item a slot on a GPU. The environment
/// variable MCDEM_LANES (1 or 16) overrides, so that a CPU can test the GPU's way.
KernelBuild kernel_build(const Device& device, Precision precision, int slots);

/// The program's text with its includes put in, as the device compiles it.
std::string program_text();

/// Throws RunError with the compiler's log.
cl::Program build_program(const Device& device, const KernelBuild& build);

}  // namespace mcdem::opencl
