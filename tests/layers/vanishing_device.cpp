// An OpenCL layer (cl_layer.h; the loader takes it from OPENCL_LAYERS) whose device stops answering: after
// MCDEM_TEST_KERNELS launches nothing more is launched, read, written or waited for. Of several processes
// only one's, where MCDEM_TEST_VICTIM names a file: that of the one that launches first, and makes it.
#define CL_TARGET_OPENCL_VERSION 300
#include <CL/cl_layer.h>
#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <cstring>

namespace {

cl_icd_dispatch below, layer;
std::atomic<long> launches_left;

bool is_victim() {
    const char* file = std::getenv("MCDEM_TEST_VICTIM");
    if (!file) return true;
    const int made = open(file, O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (made >= 0) close(made);
    return made >= 0;
}

bool gone() { return launches_left.load() < 0; }

cl_int launch(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t* offset,
              const size_t* global, const size_t* local, cl_uint events, const cl_event* after,
              cl_event* event) {
    static const bool vanishes = is_victim();
    if (vanishes && launches_left.fetch_sub(1) <= 0) return CL_DEVICE_NOT_AVAILABLE;
    return below.clEnqueueNDRangeKernel(queue, kernel, dimensions, offset, global, local, events, after,
                                        event);
}

cl_int finish(cl_command_queue queue) { return gone() ? CL_DEVICE_NOT_AVAILABLE : below.clFinish(queue); }

cl_int read(cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset, size_t size, void* data,
            cl_uint events, const cl_event* after, cl_event* event) {
    return gone()
               ? CL_DEVICE_NOT_AVAILABLE
               : below.clEnqueueReadBuffer(queue, buffer, blocking, offset, size, data, events, after, event);
}

cl_int write(cl_command_queue queue, cl_mem buffer, cl_bool blocking, size_t offset, size_t size,
             const void* data, cl_uint events, const cl_event* after, cl_event* event) {
    return gone() ? CL_DEVICE_NOT_AVAILABLE
                  : below.clEnqueueWriteBuffer(queue, buffer, blocking, offset, size, data, events, after,
                                               event);
}

}  // namespace

extern "C" {

cl_int CL_API_CALL clGetLayerInfo(cl_layer_info name, size_t size, void* value, size_t* size_used) {
    const cl_layer_api_version version = CL_LAYER_API_VERSION_100;
    if (name != CL_LAYER_API_VERSION || (value && size < sizeof version)) return CL_INVALID_VALUE;
    if (value) std::memcpy(value, &version, sizeof version);
    if (size_used) *size_used = sizeof version;
    return CL_SUCCESS;
}

cl_int CL_API_CALL clInitLayer(cl_uint entries, const cl_icd_dispatch* target, cl_uint* entries_used,
                               const cl_icd_dispatch** dispatch) {
    constexpr auto known = sizeof(cl_icd_dispatch) / sizeof(target->clGetPlatformIDs);
    if (entries < known) return CL_INVALID_VALUE;
    const char* launches = std::getenv("MCDEM_TEST_KERNELS");
    launches_left = launches ? std::atol(launches) : 0;
    below = layer = *target;
    layer.clEnqueueNDRangeKernel = launch;
    layer.clFinish = finish;
    layer.clEnqueueReadBuffer = read;
    layer.clEnqueueWriteBuffer = write;
    *entries_used = known;
    *dispatch = &layer;
    return CL_SUCCESS;
}
}
