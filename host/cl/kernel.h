// A kernel whose argument types are checked at compile time of the host.
#pragma once
#include <fmt/format.h>

#include "cl/field.h"
#include "cl/profile.h"

namespace mcdem::inline opencl {

/// The two copies of a double-buffered quantity: the one that a step reads, and the one that it writes.
template <class Quantity>
struct Now {
    Field<Quantity>& field;
};
template <class Quantity>
struct Next {
    Field<Quantity>& field;
};

/// Throws InputError if the device cannot run work-groups of this size with this kernel.
void expect_launchable(const Device& device, const cl::Kernel& kernel, int work_items);

/// `Arguments`: int, Field<..>, Now<..> or Next<..>, in the order of the kernel.
template <class... Arguments>
class Kernel {
public:
    Kernel() = default;
    /// `name` must outlive the kernel; `work_items`: size of a work-group.
    Kernel(Device& device, const cl::Program& program, const char* name, int work_items)
        : queue_(device.queue()), kernel_(program, name), name_(name), work_items_(work_items) {
        expect_launchable(device, kernel_, work_items);
        const auto wanted = kernel_.getInfo<CL_KERNEL_NUM_ARGS>();
        if (wanted != sizeof...(Arguments))
            throw RunError(fmt::format(
                "the kernel {} takes {} arguments, the host has {}: the kernels are of another version", name,
                wanted, sizeof...(Arguments)));
    }

    /// Enqueues the work-groups; does not wait.
    void operator()(std::size_t groups, const Arguments&... arguments) {
        if (groups == 0) return;
        cl_uint index = 0;
        (set(index++, arguments), ...);
        const cl::NDRange all(groups * work_items_), group(work_items_);
        if (!is_profiling()) {
            queue_.enqueueNDRangeKernel(kernel_, cl::NullRange, all, group);
            return;
        }
        cl::Event event;
        queue_.enqueueNDRangeKernel(kernel_, cl::NullRange, all, group, nullptr, &event);
        profile_launch(name_, event);
    }

private:
    void set(cl_uint index, int value) { kernel_.setArg(index, value); }
    template <class Quantity>
    void set(cl_uint index, const Field<Quantity>& field) {
        kernel_.setArg(index, field.buffer());
    }
    template <class Quantity>
    void set(cl_uint index, const Now<Quantity>& now) {
        set(index, now.field);
    }
    template <class Quantity>
    void set(cl_uint index, const Next<Quantity>& next) {
        set(index, next.field);
    }
    cl::CommandQueue queue_;
    cl::Kernel kernel_;
    const char* name_ = "";
    std::size_t work_items_ = 1;
};

}  // namespace mcdem::opencl
