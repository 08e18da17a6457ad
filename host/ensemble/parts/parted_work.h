// Work that is divided into parts. Any process can compute any part, in any order (README.md in the parent
// folder).
#pragma once
#include <cstddef>
#include <functional>
#include <vector>

#include "cl/device.h"

namespace mcdem::inline ensemble {

/// Parts are deterministic, and their results are moved into place by a rename. If two processes compute the
/// same part, the results are bit-identical. Parts are not claimed; scheduling is left to the caller.
class PartedWork {
public:
    virtual ~PartedWork() = default;

    /// Number of all parts.
    virtual std::size_t count() = 0;

    /// Numbers of the missing parts that can be computed now, from 0; empty when all are computed.
    virtual std::vector<std::size_t> missing() = 0;

    /// Computes a part, unless a complete one exists. Throws Interrupted, InputError and RunError.
    virtual void compute(Device& device, std::size_t part) = 0;

    /// Merges the parts when none is missing. Returns false if one is damaged; it is then missing again.
    /// Throws Interrupted; the parts are then as before.
    virtual bool merge() = 0;

    /// Called while a part is computed, with the completed fraction of the part.
    std::function<void(double fraction)> on_progress = [](double) {};
};

}  // namespace mcdem::ensemble
