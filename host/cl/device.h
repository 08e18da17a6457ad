// OpenCL devices as users choose them, and the one context and queue that a program works on.
#pragma once
#include <string>
#include <vector>

#include "cl/opencl.h"
#include "core/errors.h"

namespace mcdem::inline opencl {

struct DeviceInfo {
    int index = 0;  ///< what `--device` takes
    std::string name;
    std::string platform;
    std::string version;  ///< of device and driver
    bool gpu = false;
    bool double_precision = false;
    int compute_units = 0;
    std::size_t memory = 0;              ///< [bytes]
    std::size_t largest_allocation = 0;  ///< of memory in one piece [bytes]
    int largest_work_group = 0;          ///< work-items
};

/// What to say where there is none.
RunError no_device();

/// Every OpenCL device, GPUs first (the order of `--device`).
std::vector<DeviceInfo> list_devices();

/// The numbers of all devices that give the same bits as the one that `choice` means (see Device): of its
/// name, platform and driver. A choice by number means that one alone.
std::vector<int> alike_devices(const std::string& choice);

/// One device with its context and in-order queue.
class Device {
public:
    /// `choice`: empty (environment variable MCDEM_DEVICE, else the first GPU, else the first device), an
    /// index, or part of a name. Throws InputError naming the devices there are when nothing matches.
    explicit Device(const std::string& choice = "");

    const DeviceInfo& info() const { return info_; }
    std::string description() const;  ///< name and driver, for provenance
    const cl::Context& context() const { return context_; }
    cl::CommandQueue& queue() { return queue_; }
    const cl::Device& handle() const { return handle_; }
    void finish() { queue_.finish(); }

private:
    DeviceInfo info_;
    cl::Device handle_;
    cl::Context context_;
    cl::CommandQueue queue_;
};

}  // namespace mcdem::opencl
