// Comparison of a device with the reference before its first use (sim/device_check.h).
#pragma once
#include "cl/device.h"
#include "sim/device_check.h"

namespace mcdem::inline cli {

/// Compares the device. A pass is recorded in the user's cache folder, for this device, its driver, the
/// kernels and this version of the program.
DeviceCheck check_and_record(Device& device, Precision precision);

/// The same, unless it has passed before. Throws RunError with a remedy if it fails.
void check_at_first_use(Device& device, Precision precision);

}  // namespace mcdem::cli
