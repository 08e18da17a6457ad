// Adds the name of the device to a benchmark's output.
#pragma once
#include <benchmark/benchmark.h>

#include "cl/device.h"

namespace mcdem::bench {

inline void add_device_context(const Device& device) {
    benchmark::AddCustomContext("device", device.description());
    benchmark::AddCustomContext("device_kind", device.info().gpu ? "gpu" : "cpu");
}

}  // namespace mcdem::bench
