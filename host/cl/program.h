// The kernels as one OpenCL program, from the embedded text or from the folder given by the environment
// variable MCDEM_KERNELS.
#pragma once
#include <algorithm>

#include "cl/device.h"
#include "core/names.h"

namespace mcdem::inline opencl {

/// Parameters of a build of the kernels.
struct KernelBuild {
    Precision precision = Precision::single_precision;
    int slots = 16;   ///< neighbour slots per grain, a multiple of 16
    int lanes = 16;   ///< 16: one work-item per 16 grains (CPU); 1: one work-item per slot (GPU)
    int species = 1;  ///< maximum number of materials in a replica: 1 or MAX_SPECIES of kernels/material.h
    int group = 256;  ///< maximum size of a work-group; all known GPUs support 256

    /// Grains per block; a work-group of a step processes one block.
    int block() const { return lanes > 1 ? 16 : std::clamp(group / slots, 1, 16); }
    /// Size of a work-group of a step.
    int work_items() const { return lanes > 1 ? block() / lanes : block() * slots; }
    /// Size of a work-group of the kernels that build lists with one work-item per grain.
    int list_items() const { return std::min(group, lanes > 1 ? block() : 64); }
    /// Size of a work-group of `list_neighbours`, with one work-item per `lanes` grains.
    int search_items() const { return lanes > 1 ? 1 : list_items(); }
    /// Grain of a place in fields with one number per slot (SLOT_PLACE in kernels/lanes.h).
    std::size_t grain_of_slot(std::size_t place) const {
        const auto wide = static_cast<std::size_t>(lanes), all = static_cast<std::size_t>(slots);
        return place / (wide * all) * wide + place % wide;
    }
    /// Place of a grain's slot in such a field, or in row `row` of a field with `rows` numbers per slot.
    std::size_t place_of_slot(std::size_t grain, std::size_t slot, int row = 0, int rows = 1) const {
        const auto wide = static_cast<std::size_t>(lanes), all = static_cast<std::size_t>(slots);
        return ((grain / wide * rows + row) * all + slot) * wide + grain % wide;
    }
};

/// The build for `device`: vectors of grains on a CPU, one work-item per slot on a GPU. The environment
/// variable MCDEM_LANES (1 or 16) overrides this, so that a CPU can test the GPU layout.
KernelBuild kernel_build(const Device& device, Precision precision, int slots);

/// Text of the program with all includes expanded, as the device compiles it.
std::string program_text();

/// Throws RunError with the log of the compiler.
cl::Program build_program(const Device& device, const KernelBuild& build);

}  // namespace mcdem::opencl
