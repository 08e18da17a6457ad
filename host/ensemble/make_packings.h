// Initial packings of all replicas of a scene, and runs in memory.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "cl/device.h"
#include "core/recording.h"
#include "core/stop.h"
#include "scene/scene.h"

namespace mcdem::inline ensemble {

/// One packing per replica, in order, computed on all cores; replicas with the same initial packing share the
/// work. Throws InputError with all problems, Interrupted.
std::vector<Packing> make_packings(const Scene& scene, const StopWanted& stop_wanted = never_stop);

/// What simulations tell their caller, and ask.
struct Callbacks {
    std::function<void(double fraction)> on_progress = [](double) {};  ///< completed part of the protocol
    StopWanted stop_wanted = never_stop;
    /// Receives the index of a simulation and why it failed.
    std::function<void(std::size_t, const Failure&)> on_failure = [](std::size_t, const Failure&) {};
};

/// When simulations end before their protocols do.
struct EarlyEnd {
    std::size_t scans = SIZE_MAX;  ///< all end as soon as each has failed or has this number of scans
    /// Asked after each scan: whether this replica needs no more.
    std::function<bool(std::size_t replica, const Recording&)> is_enough = [](std::size_t, const Recording&) {
        return false;
    };
};

/// Runs a scene without files: one recording per replica. Throws Interrupted if stop_wanted returns true.
std::vector<Recording> simulate(Device& device, const Scene& scene, const std::vector<Packing>& packings,
                                const Callbacks& callbacks = {}, const EarlyEnd& early = {});

}  // namespace mcdem::ensemble
