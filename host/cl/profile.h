// Device profile: with MCDEM_PROFILE=1 every launch has an event, and a run prints the sums at its end.
#pragma once
#include <string>
#include <vector>

#include "cl/opencl.h"

namespace mcdem::inline opencl {

/// Whether MCDEM_PROFILE is 1.
bool is_profiling();

/// Records a launch. Events are awaited and summed once every thousand launches.
void profile_launch(const char* kernel, const cl::Event& event);

/// Table of kernels: launches, time, and fraction of the time from the first launch to the last end; then the
/// fraction in which the device waited. Empty if nothing was recorded.
std::string profile_text();

}  // namespace mcdem::opencl
