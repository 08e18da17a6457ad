// Selection of OpenCL devices, and the context and queue of a program.
#pragma once
#include <string>
#include <vector>

#include "cl/opencl.h"
#include "core/errors.h"

namespace mcdem::inline opencl {

struct DeviceInfo {
    int index = 0;  ///< number for `--device`
    std::string name;
    std::string platform;
    std::string version;  ///< of device and driver
    bool gpu = false;
    bool double_precision = false;
    int compute_units = 0;
    std::size_t memory = 0;              ///< [bytes]
    std::size_t largest_allocation = 0;  ///< size of the largest single buffer [bytes]
    int largest_work_group = 0;          ///< work-items
};

/// The error if there is no device.
RunError no_device();

/// All OpenCL devices, GPUs first, in the order of `--device`.
std::vector<DeviceInfo> list_devices();

/// Numbers of all devices that give the same bits as the one selected by `choice` (see Device): those with
/// the same name, platform and driver. A choice by number selects only that device.
std::vector<int> alike_devices(const std::string& choice);

/// One device with its context and in-order queue.
class Device {
public:
    /// `choice`: empty (environment variable MCDEM_DEVICE, otherwise the first GPU, otherwise the first
    /// device), an index, or part of a name. Throws InputError with the list of devices if nothing matches.
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
