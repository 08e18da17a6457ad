// Device memory with its quantity in the type, so that swapped kernel arguments do not compile.
#pragma once
#include <utility>
#include <vector>

#include "cl/device.h"

namespace mcdem::inline opencl {

/// Copies from the device that may still be under way. The destructor waits for their end, because the device
/// writes into the host's memory until then.
class PendingCopies {
public:
    PendingCopies() = default;
    PendingCopies(PendingCopies&& other) noexcept : last_(std::exchange(other.last_, {})) {}
    ~PendingCopies() {
        try {
            wait();
        } catch (const cl::Error&) {  // the device has failed and copies no more
        }
    }
    /// The queue keeps its order, so the end of this copy is that of all before it.
    void add(cl::Event end) { last_ = std::move(end); }
    void wait() const {
        if (last_()) last_.wait();
    }

private:
    cl::Event last_;
};

/// Device memory for `Quantity`, which is only a tag type. Elements may be reals of either precision; the
/// size of an element is set in the constructor.
template <class Quantity>
class Field {
public:
    Field() = default;
    /// `count` elements of `element_size` bytes, zero-initialised. At least one element is allocated, because
    /// OpenCL has no empty buffers.
    Field(Device& device, std::size_t count, std::size_t element_size)
        : queue_(device.queue()), bytes_(std::max<std::size_t>(count, 1) * element_size) {
        buffer_ = cl::Buffer(device.context(), CL_MEM_READ_WRITE, bytes_);
        queue_.enqueueFillBuffer(buffer_, cl_uchar{0}, 0, bytes_);
    }

    std::size_t bytes() const { return bytes_; }
    const cl::Buffer& buffer() const { return buffer_; }

    /// Copies the whole field from or to host memory of bytes() bytes; returns when done.
    void write(const void* data) { queue_.enqueueWriteBuffer(buffer_, CL_TRUE, 0, bytes_, data); }
    void read(void* data) const { queue_.enqueueReadBuffer(buffer_, CL_TRUE, 0, bytes_, data); }
    /// Copies `size` bytes from `offset`.
    void read(void* data, std::size_t offset, std::size_t size) const {
        if (size > 0) queue_.enqueueReadBuffer(buffer_, CL_TRUE, offset, size, data);
    }
    /// Starts to copy `size` bytes, at least one, from `offset`; `data` must exist until `copies` has ended.
    void begin_read(void* data, std::size_t offset, std::size_t size, PendingCopies& copies) const {
        cl::Event end;
        queue_.enqueueReadBuffer(buffer_, CL_FALSE, offset, size, data, nullptr, &end);
        copies.add(std::move(end));
    }
    void write(const void* data, std::size_t offset, std::size_t size) {
        if (size > 0) queue_.enqueueWriteBuffer(buffer_, CL_TRUE, offset, size, data);
    }
    /// Lets the device start with everything that is enqueued.
    void flush() const { queue_.flush(); }

private:
    mutable cl::CommandQueue queue_;
    cl::Buffer buffer_;
    std::size_t bytes_ = 0;
};

}  // namespace mcdem::opencl
