// State of an unfinished run on disk: contents of a checkpoint, and whether one fits.
#pragma once
#include <functional>
#include <optional>

#include "cl/device.h"
#include "io/checkpoint.h"
#include "io/result_folder.h"
#include "scene/scene.h"

namespace mcdem::inline ensemble {

/// Properties that must be the same to resume a run with bit-identical results.
struct RunIdentity {
    std::string scene_text;
    std::string device;    ///< including the build of the kernels: both determine the bits
    std::string program;   ///< version and commit
    std::string kernels;   ///< digest: a program with other kernels would go on with other bits
    std::string packings;  ///< digest: a packing file may change under the same name
};
RunIdentity identity_of(const Device& device, const Scene& scene, const std::string& program,
                        const std::vector<Packing>& packings);

/// The current checkpoint of this run; `fields` come from Simulation::save.
Checkpoint make_checkpoint(const RunIdentity& identity, int segments,
                           std::map<std::string, std::vector<std::byte>> fields);

/// Throws InputError if the folder cannot be used for a run: it contains an experiment, answers to a
/// challenge, or a plate.csv that is not from a run.
void expect_room_for_run(const std::filesystem::path& folder);

/// Throws InputError if the finished run in `folder` has another scene.
void expect_scene_of(const std::filesystem::path& folder, const Scene& scene);

/// Checkpoint from which the run in `folder` resumes; none: from the start. Throws InputError if the folder
/// contains another run. Calls `on_warning` if results may differ from those of an uninterrupted run.
std::optional<Checkpoint> find_checkpoint(const ResultFolder& folder, const RunIdentity& identity,
                                          const std::function<void(const std::string&)>& on_warning);

}  // namespace mcdem::ensemble
