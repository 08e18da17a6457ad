// An OpenCL layer (cl_layer.h; the loader takes it from OPENCL_LAYERS) for tests that need a run in the
// middle of its work. After MCDEM_TEST_KERNELS launches its device stops answering: nothing more is launched,
// read, written or waited for. Where MCDEM_TEST_HOLD names a folder, the process waits there instead, once:
// it makes a file named by its number in the folder, and goes on when that is removed. Of several processes
// only one does so where MCDEM_TEST_VICTIM names a file: the one that launches first, and makes it.
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

/// What is held stays held at any speed of the machine: only the test lets it go on.
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
