// A kernel whose argument types are checked when the host is compiled.
#pragma once
#include "cl/field.h"

namespace mcdem {

/// `Arguments`: int or Field<..>, in the kernel's order.
template <class... Arguments>
class Kernel {
public:
    Kernel() = default;
    Kernel(Device& device, const cl::Program& program, const char* name)
        : queue_(device.queue()), kernel_(program, name) {}

    /// Enqueues `groups` work-groups of `work_items` each; does not wait.
    void operator()(std::size_t groups, std::size_t work_items, const Arguments&... arguments) {
        if (groups == 0) return;
        cl_uint index = 0;
        (set(index++, arguments), ...);
        queue_.enqueueNDRangeKernel(kernel_, cl::NullRange, cl::NDRange(groups * work_items),
                                    cl::NDRange(work_items));
    }

private:
    void set(cl_uint index, int value) { kernel_.setArg(index, value); }
    template <class Quantity>
    void set(cl_uint index, const Field<Quantity>& field) {
        kernel_.setArg(index, field.buffer());
    }
    cl::CommandQueue queue_;
    cl::Kernel kernel_;
};

}  // namespace mcdem
