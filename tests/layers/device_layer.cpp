// An OpenCL layer (cl_layer.h, loaded through OPENCL_LAYERS) for tests that need a run in progress. After
// MCDEM_TEST_KERNELS launches the device stops responding: nothing is launched, read, written or waited for
// any more. If MCDEM_TEST_HOLD names a folder, the process blocks there instead, once: it creates a file
// named by its process number in the folder, and continues when the file is removed. If MCDEM_TEST_VICTIM
// names a file, only the process that creates this file, the first one to launch, is affected. If
// MCDEM_TEST_AFTER names a file, launches count only once it exists.
#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <limits>
#include <string>

#include "layer.h"

namespace {

std::atomic<long> launches_left;

bool is_victim() {
    const char* file = std::getenv("MCDEM_TEST_VICTIM");
    if (!file) return true;
    const int made = open(file, O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (made >= 0) close(made);
    return made >= 0;
}

/// Only the test ends the wait, so that tests do not depend on the speed of the machine.
void hold(const char* folder) {
    const std::string file = std::string(folder) + "/" + std::to_string(getpid());
    close(open(file.c_str(), O_CREAT | O_CLOEXEC, 0600));
    while (access(file.c_str(), F_OK) == 0) usleep(1000);
    launches_left = std::numeric_limits<long>::max();
}

bool counts() {
    const char* file = std::getenv("MCDEM_TEST_AFTER");
    return !file || access(file, F_OK) == 0;
}

bool gone() { return launches_left.load() < 0; }

cl_int launch(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions, const size_t* offset,
              const size_t* global, const size_t* local, cl_uint events, const cl_event* after,
              cl_event* event) {
    if (!counts())
        return below.clEnqueueNDRangeKernel(queue, kernel, dimensions, offset, global, local, events, after,
                                            event);
    static const bool chosen = is_victim();
    if (chosen && launches_left.fetch_sub(1) <= 0) {
        const char* folder = std::getenv("MCDEM_TEST_HOLD");
        if (!folder) return CL_DEVICE_NOT_AVAILABLE;
        hold(folder);
    }
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

void take_over() {
    const char* launches = std::getenv("MCDEM_TEST_KERNELS");
    launches_left = launches ? std::atol(launches) : 0;
    layer.clEnqueueNDRangeKernel = launch;
    layer.clFinish = finish;
    layer.clEnqueueReadBuffer = read;
    layer.clEnqueueWriteBuffer = write;
}

}  // namespace
