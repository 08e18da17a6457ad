#include "ensemble/make_packings.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <map>

#include "core/errors.h"
#include "core/in_parallel.h"
#include "scene/packing/make_packing.h"
#include "sim/simulation.h"

namespace mcdem::inline ensemble {
namespace {

/// Text with all inputs of make_packing: equal texts mean equal packings.
std::string start_of(const Replica& replica) {
    const PackingSource& from = replica.packing;
    std::string text = fmt::format("{} {} {} {} {} {} {} {}", name(replica.box.shape), replica.box.size_x,
                                   replica.box.size_y, replica.plate.start, replica.effects.plate_tilt_x,
                                   replica.effects.plate_tilt_y, from.position_jitter, from.seed);
    text += fmt::format(" {}", name(from.fractions_by));
    for (const Species& one : replica.species) {
        const Sizes& sizes = one.sizes;
        text += fmt::format(" species {} {} {} {} {} {} {} {}", one.name, one.fraction, name(sizes.law),
                            sizes.mean, sizes.sd, sizes.min, sizes.max, sizes.file);
    }
    if (const auto* file = std::get_if<PackingFile>(&from.source))
        return text + fmt::format(" file {} {}", file->path, file->step.value_or(-1));
    const auto& drawn = std::get<GeneratedPacking>(from.source);
    return text + fmt::format(" drawn {} {} {} {} {} {}", drawn.count, drawn.diameter_mean, drawn.diameter_sd,
                              drawn.diameter_min, drawn.diameter_max, drawn.packing_fraction);
}

/// Throws the first error that is not an InputError, otherwise all problems of input, each once.
void report(const std::vector<std::exception_ptr>& errors) {
    std::vector<std::string> problems;
    for (const auto& error : errors) try {
            if (error) std::rethrow_exception(error);
        } catch (const InputError& found) {
            for (const auto& problem : found.problems())
                if (std::find(problems.begin(), problems.end(), problem) == problems.end())
                    problems.push_back(problem);
        }
    if (!problems.empty()) throw InputError(problems);
}

}  // namespace

std::vector<Packing> make_packings(const Scene& scene, const StopWanted& stop_wanted) {
    std::vector<const Replica*> different;
    std::vector<std::size_t> which;  // by replica
    std::map<std::string, std::size_t> seen;
    for (const auto& replica : scene.replicas) {
        const auto [place, is_new] = seen.try_emplace(start_of(replica), different.size());
        if (is_new) different.push_back(&replica);
        which.push_back(place->second);
    }
    std::vector<Packing> made(different.size());
    std::vector<std::exception_ptr> errors(different.size());
    in_parallel(different.size(), [&](std::size_t i) {
        if (stop_wanted()) return;
        try {
            made[i] = make_packing(*different[i]);
        } catch (...) {
            errors[i] = std::current_exception();
        }
    });
    if (stop_wanted()) throw Interrupted();
    report(errors);
    std::vector<Packing> packings;
    for (const std::size_t i : which) packings.push_back(made[i]);
    return packings;
}

std::vector<Recording> simulate(Device& device, const Scene& scene, const std::vector<Packing>& packings,
                                const Callbacks& callbacks, const EarlyEnd& early) {
    std::vector<Recording> recordings;
    for (std::size_t r = 0; r < packings.size(); ++r)
        recordings.push_back(begin_recording(scene.replicas[r], packings[r]));
    Simulation simulation(device, scene, packings);
    const auto keep = [&](int replica, Scan& scan) {
        const auto r = static_cast<std::size_t>(replica);
        recordings[r].scans.push_back(std::move(scan));
        if (early.is_enough(r, recordings[r])) simulation.end(replica);
    };
    const auto note = [&](int replica, const Failure& failure) {
        const auto r = static_cast<std::size_t>(replica);
        recordings[r].failure = failure;
        callbacks.on_failure(r, failure);
    };
    const auto complete = [&](const Recording& recording) {
        return recording.failure || recording.scans.size() >= early.scans;
    };
    while (!std::ranges::all_of(recordings, complete) && simulation.advance(keep, note)) {
        callbacks.on_progress(simulation.progress());
        if (callbacks.stop_wanted()) throw Interrupted();
    }
    return recordings;
}

}  // namespace mcdem::ensemble
