// Where a device's time goes: with MCDEM_PROFILE=1 every launch leaves an event, and a run ends with the
// sums.
#pragma once
#include <string>
#include <vector>

#include "cl/opencl.h"

namespace mcdem::inline opencl {

/// MCDEM_PROFILE is 1.
bool is_profiling();

/// Takes note of a launch. What is noted is summed up, and waited for, a thousand launches at a time.
void profile_launch(const char* kernel, const cl::Event& event);

/// A table of kernels: launches, time, and the share of the time from the first launch to the last end; then
/// the share in which the device waited. Empty where nothing was noted.
std::string profile_text();

}  // namespace mcdem::opencl
