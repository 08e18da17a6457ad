// Work that is cut into parts, each of which any process computes alone, in any order (README.md beside this
// file).
#pragma once
#include <cstddef>
#include <functional>
#include <vector>

#include "cl/device.h"

namespace mcdem::inline ensemble {

/// A part is deterministic, and its result is put in place in one move: one that is computed twice, or by two
/// processes at a time, is the same to the last bit. Nobody claims a part; who schedules them is another's.
class PartedWork {
public:
    virtual ~PartedWork() = default;

    /// Numbers of the parts that can be computed now and are not there; none when nothing is left to compute.
    virtual std::vector<std::size_t> missing() = 0;

    /// Computes a part, unless a whole one is there. False where it was interrupted. Throws InputError and
    /// RunError.
    virtual bool compute(Device& device, std::size_t part) = 0;

    /// Puts the parts together once none is missing. False where one turned out to be damaged: it is missing
    /// again.
    virtual bool merge() = 0;

    /// Called while a part is computed, with the fraction of it that is done.
    std::function<void(double fraction)> on_progress = [](double) {};
};

}  // namespace mcdem::ensemble
