// Parts of a work dealt to the devices of this machine, a process on each.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace mcdem::inline cli {

/// Runs `words --part K --device D` for every part. A device whose process fails is taken out of `devices`,
/// and another gets the part; so it is after a signal, but for a part whose processes were killed three
/// times. Returns an exit code: interrupted; bad input, told by a process; failed, where no device is left;
/// else done.
int deal_to_devices(const std::vector<std::string>& words, const std::vector<std::size_t>& parts,
                    std::vector<int>& devices);

}  // namespace mcdem::cli
