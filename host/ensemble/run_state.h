// A run in progress as it lies on the disk: what belongs in a checkpoint, and whether one suits.
#pragma once
#include <optional>

#include "cl/device.h"
#include "io/checkpoint.h"
#include "io/result_folder.h"
#include "scene/scene.h"

namespace mcdem::inline ensemble {

/// What must be the same for a run to go on as if it had not stopped.
struct RunIdentity {
    std::string scene_text;
    std::string device;    ///< with the build of the kernels: both decide the bits
    std::string program;   ///< version and commit
    std::string packings;  ///< digest: a packing file may change while its name does not
};
RunIdentity identity_of(const Device& device, const Scene& scene, const std::string& program,
                        const std::vector<Packing>& packings);

/// The checkpoint of this run at the moment; `fields` come from Simulation::save.
Checkpoint make_checkpoint(const RunIdentity& identity, int segments,
                           std::map<std::string, std::vector<std::byte>> fields);

/// Throws InputError where a run cannot have the folder: an experiment or a challenge's answers lie there, or
/// a plate.csv that is no run's.
void expect_room_for_run(const std::filesystem::path& folder);

/// Throws InputError when the finished run in `folder` is of another scene.
void expect_scene_of(const std::filesystem::path& folder, const Scene& scene);

/// Where the run in `folder` is to go on; none: at its beginning. Throws InputError when what lies there
/// is another run. Fills in Checkpoint::warning where results may differ from an uninterrupted run.
std::optional<Checkpoint> find_checkpoint(const ResultFolder& folder, const RunIdentity& identity);

}  // namespace mcdem::ensemble
