// An OpenCL layer (cl_layer.h, loaded through OPENCL_LAYERS) that makes a CPU emulate a GPU: it reports a
// GPU with 48 KB of local memory and work-groups of at most MCDEM_TEST_GROUP work-items (default 256), and
// refuses larger launches as drivers do. MCDEM_TEST_KERNEL_GROUP limits the work-items of every kernel, as a
// lack of registers does.

#include <algorithm>
#include <cstdlib>

#include "layer.h"

namespace {

constexpr cl_ulong local_memory = 48 << 10;

std::size_t number(const char* variable, std::size_t otherwise) {
    const char* value = std::getenv(variable);
    return value ? std::strtoul(value, nullptr, 10) : otherwise;
}
std::size_t group() { return number("MCDEM_TEST_GROUP", 256); }
std::size_t kernel_group() { return number("MCDEM_TEST_KERNEL_GROUP", group()); }

cl_int device_info(cl_device_id device, cl_device_info name, std::size_t size, void* value,
                   std::size_t* used) {
    const cl_int status = below.clGetDeviceInfo(device, name, size, value, used);
    if (status != CL_SUCCESS || !value) return status;
    if (name == CL_DEVICE_TYPE) *static_cast<cl_device_type*>(value) = CL_DEVICE_TYPE_GPU;
    if (name == CL_DEVICE_MAX_WORK_GROUP_SIZE) *static_cast<std::size_t*>(value) = group();
    if (name == CL_DEVICE_LOCAL_MEM_SIZE) *static_cast<cl_ulong*>(value) = local_memory;
    return status;
}

cl_int kernel_info(cl_kernel kernel, cl_device_id device, cl_kernel_work_group_info name, std::size_t size,
                   void* value, std::size_t* used) {
    const cl_int status = below.clGetKernelWorkGroupInfo(kernel, device, name, size, value, used);
    if (status == CL_SUCCESS && value && name == CL_KERNEL_WORK_GROUP_SIZE)
        *static_cast<std::size_t*>(value) = std::min(*static_cast<std::size_t*>(value), kernel_group());
    return status;
}

/// Local memory that the kernel declares; no kernel has local memory as an argument.
bool fits_local_memory(cl_kernel kernel) {
    cl_ulong needed = 0;
    below.clGetKernelWorkGroupInfo(kernel, nullptr, CL_KERNEL_LOCAL_MEM_SIZE, sizeof needed, &needed,
                                   nullptr);
    return needed <= local_memory;
}

cl_int launch(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const std::size_t* offset,
              const std::size_t* global, const std::size_t* local, cl_uint events, const cl_event* after,
              cl_event* event) {
    std::size_t items = 1;
    for (cl_uint d = 0; local && d < dimensions; ++d) items *= local[d];
    if (items > kernel_group()) return CL_INVALID_WORK_GROUP_SIZE;
    if (!fits_local_memory(kernel)) return CL_OUT_OF_RESOURCES;
    return below.clEnqueueNDRangeKernel(queue, kernel, dimensions, offset, global, local, events, after,
                                        event);
}

void take_over() {
    layer.clGetDeviceInfo = device_info;
    layer.clGetKernelWorkGroupInfo = kernel_info;
    layer.clEnqueueNDRangeKernel = launch;
}

}  // namespace
