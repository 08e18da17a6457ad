#include "cl/profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <map>

namespace mcdem::inline opencl {
namespace {

constexpr std::size_t kept_events = 1000;

struct Sum {
    long launches = 0;
    double seconds = 0;
};

struct Profile {
    std::vector<std::pair<const char*, cl::Event>> noted;
    std::map<std::string, Sum> sums;
    cl_ulong first = std::numeric_limits<cl_ulong>::max(), last = 0;  ///< time of the device's clock [ns]

    void add_up() {
        for (const auto& [kernel, event] : noted) {
            event.wait();
            const cl_ulong start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>(),
                           end = event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
            Sum& sum = sums[kernel];
            ++sum.launches;
            sum.seconds += 1e-9 * static_cast<double>(end - start);
            first = std::min(first, start);
            last = std::max(last, end);
        }
        noted.clear();
    }
};

Profile& profile() {
    static Profile the_profile;
    return the_profile;
}

}  // namespace

bool is_profiling() {
    static const bool asked = [] {
        const char* value = std::getenv("MCDEM_PROFILE");
        return value && std::string(value) == "1";
    }();
    return asked;
}

void profile_launch(const char* kernel, const cl::Event& event) {
    profile().noted.emplace_back(kernel, event);
    if (profile().noted.size() >= kept_events) profile().add_up();
}

std::string profile_text() {
    Profile& all = profile();
    all.add_up();
    if (all.sums.empty()) return "";
    const double whole = 1e-9 * static_cast<double>(all.last - all.first);
    double busy = 0;
    std::string text = fmt::format("{:<20}{:>10}{:>10}{:>14}{:>8}\n", "kernel", "launches", "time [s]",
                                   "a launch [us]", "share");
    for (const auto& [kernel, sum] : all.sums) {
        busy += sum.seconds;
        text += fmt::format("{:<20}{:>10}{:>10.3f}{:>14.1f}{:>6.1f} %\n", kernel, sum.launches, sum.seconds,
                            1e6 * sum.seconds / static_cast<double>(sum.launches), 100 * sum.seconds / whole);
    }
    return text + fmt::format("{:<20}{:>10}{:>10.3f}{:>14}{:>6.1f} %\n", "device waits", "", whole - busy, "",
                              100 * (whole - busy) / whole);
}

}  // namespace mcdem::opencl
