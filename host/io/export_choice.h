// Which replicas and scans of a run are exported.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/errors.h"
#include "core/recording.h"

namespace mcdem::inline io {

/// Numbers of replicas and of scans (Scan::frame); an empty list stands for all.
struct ExportChoice {
    std::vector<int> replicas = {}, scans = {};

    bool has_replica(std::size_t number) const { return has(replicas, static_cast<int>(number)); }
    bool has_scan(int frame) const { return has(scans, frame); }

private:
    static bool has(const std::vector<int>& list, int number) {
        return list.empty() || std::ranges::find(list, number) != list.end();
    }
};

/// Throws InputError where a replica is chosen that the run has not.
inline void expect_replicas(const ExportChoice& choice, const Run& run) {
    for (const int number : choice.replicas)
        if (number < 0 || number >= static_cast<int>(run.recordings.size()))
            throw InputError(
                fmt::format("--replica: must be one of 0 to {}, got {}", run.recordings.size() - 1, number));
}

}  // namespace mcdem::io
