#include "cl/device.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <mutex>

#include "cl/held_signals.h"
#include "cl/kernel_cache.h"
#include "cl/pip_driver.h"
#include "cl/profile.h"
#include "core/stack.h"

namespace mcdem::inline opencl {
namespace {

struct Found {
    DeviceInfo info;
    cl::Device handle;
};

/// OpenCL strings may end in a null byte or blanks.
std::string trimmed(std::string text) {
    while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) text.pop_back();
    return text;
}

DeviceInfo describe(const cl::Platform& platform, const cl::Device& device) {
    DeviceInfo info;
    info.name = trimmed(device.getInfo<CL_DEVICE_NAME>());
    info.platform = trimmed(platform.getInfo<CL_PLATFORM_NAME>());
    info.version = trimmed(device.getInfo<CL_DEVICE_VERSION>()) + ", driver " +
                   trimmed(device.getInfo<CL_DRIVER_VERSION>());
    info.gpu = device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_GPU;
    info.double_precision = device.getInfo<CL_DEVICE_EXTENSIONS>().find("cl_khr_fp64") != std::string::npos;
    info.compute_units = static_cast<int>(device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
    info.memory = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    info.largest_allocation = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    info.largest_work_group = static_cast<int>(device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>());
    return info;
}

bool is_pocl(const cl::Platform& platform) {
    return platform.getInfo<CL_PLATFORM_NAME>().starts_with("Portable Computing Language");
}

/// Drivers have threads, which do not exist in a forked child: it would wait for them forever.
void expect_not_forked() {
    static const pid_t first = getpid();
    if (getpid() != first)
        throw RunError(
            "OpenCL was used before this process was forked, and does not work in the child: start a new "
            "process "
            "(in Python, multiprocessing.get_context(\"spawn\"))");
}

/// Drivers crash where they cannot open files. Raises the limit to the maximum that the system allows.
void expect_enough_open_files() {
    constexpr rlim_t enough = 64, plenty = 1024;
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= plenty) return;
    rlimit raised = limit;
    raised.rlim_cur = limit.rlim_max < plenty ? limit.rlim_max : plenty;
    if (::setrlimit(RLIMIT_NOFILE, &raised) == 0) limit = raised;
    if (limit.rlim_cur < enough)
        throw RunError(
            fmt::format("the limit of open files is {}, too few for the OpenCL driver: raise it "
                        "(`ulimit -n`) to {} or more",
                        limit.rlim_cur, enough));
}

std::vector<Found> find_devices() {
    expect_not_forked();
    static std::mutex
        one_at_a_time;  // PoCL initialises its devices at the first call and is not thread-safe there
    const std::lock_guard lock(one_at_a_time);
    expect_enough_open_files();
    expect_enough_stack();
    prepare_kernel_cache();
    const HeldSignals held;  // the driver's threads take no signals
    std::vector<Found> found;
    std::vector<cl::Platform> platforms;
    try {
        cl::Platform::get(&platforms);
    } catch (const cl::Error&) {
        platforms.clear();  // the loader reports "no platform" as an error
    }
    // The user's choice of drivers, and one PoCL in a process.
    if (!std::getenv("OCL_ICD_VENDORS") && std::ranges::none_of(platforms, is_pocl)) {
        static const std::vector<cl::Platform> from_pip = pip_platforms();
        platforms.insert(platforms.end(), from_pip.begin(), from_pip.end());
    }
    for (const auto& platform : platforms) {
        std::vector<cl::Device> devices;
        try {
            platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
        } catch (const cl::Error&) {
            continue;  // a platform without devices
        }
        for (const auto& device : devices) found.push_back({describe(platform, device), device});
    }
    opencl_started();
    std::stable_sort(found.begin(), found.end(),
                     [](const Found& a, const Found& b) { return a.info.gpu > b.info.gpu; });
    for (std::size_t i = 0; i < found.size(); ++i) found[i].info.index = static_cast<int>(i);
    return found;
}

Found choose(const std::string& choice) {
    const auto found = find_devices();
    if (found.empty()) throw no_device();
    std::string wanted = choice;
    if (wanted.empty())
        if (const char* variable = std::getenv("MCDEM_DEVICE")) wanted = variable;
    if (wanted.empty()) return found.front();
    std::string known;
    for (const auto& device : found) {
        if (wanted == std::to_string(device.info.index)) return device;
        known += fmt::format("\n  {}  {}", device.info.index, device.info.name);
    }
    for (const auto& device : found)
        if ((device.info.platform + " " + device.info.name).find(wanted) != std::string::npos) return device;
    throw InputError(
        fmt::format("--device: must be the number or part of the name of a device, got '{}'; there are:{}",
                    wanted, known));
}

}  // namespace

RunError no_device() {
    return RunError(
        "no OpenCL device found: install a driver (the package pocl-opencl-icd runs on any CPU; with "
        "pip, pocl-binary-distribution); if it is there, set POCL_CACHE_DIR to a folder of your own where it "
        "can keep compiled kernels");
}

std::vector<DeviceInfo> list_devices() {
    std::vector<DeviceInfo> infos;
    for (const auto& device : find_devices()) infos.push_back(device.info);
    return infos;
}

std::vector<int> alike_devices(const std::string& choice) {
    const DeviceInfo chosen = choose(choice).info;
    std::vector<int> alike;
    for (const DeviceInfo& info : list_devices())
        if (info.name == chosen.name && info.platform == chosen.platform && info.version == chosen.version)
            alike.push_back(info.index);
    return choice == std::to_string(chosen.index) ? std::vector<int>{chosen.index} : alike;
}

Device::Device(const std::string& choice) {
    const Found found = choose(choice);
    info_ = found.info;
    handle_ = found.handle;
    context_ = cl::Context(handle_);
    queue_ = cl::CommandQueue(context_, handle_, is_profiling() ? CL_QUEUE_PROFILING_ENABLE : 0);
}

std::string Device::description() const {
    return fmt::format("{} ({}, {})", info_.name, info_.platform, info_.version);
}

}  // namespace mcdem::opencl
