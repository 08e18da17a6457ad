// Distributes parts to the devices of this machine, one process per device.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace mcdem::inline cli {

/// Runs `words --part K --device D` for every part. A device whose process fails is removed from `devices`,
/// and another one gets the part. After a signal the part is tried again on any device; it is given up when
/// its processes were killed three times. Returns an exit code: interrupted; bad input if a process reported
/// it; failed if no device is left; otherwise done. The caller has an Interrupt.
int deal_to_devices(const std::vector<std::string>& words, const std::vector<std::size_t>& parts,
                    std::vector<int>& devices);

}  // namespace mcdem::cli
