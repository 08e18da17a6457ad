// A run computed in parts, which are ranges of replicas (README.md beside this file).
#pragma once
#include "ensemble/parts/parted_work.h"
#include "ensemble/run_scene.h"
#include "io/folder_lock.h"

namespace mcdem::inline ensemble {

/// How a run is cut.
struct RunCut {
    std::size_t part_replicas = 0;  ///< of a part; 0: enough to fill a device, but two parts a worker
    std::size_t workers = 1;        ///< that are known to come
};

/// The merged folder holds what run_scene leaves in it, bit for bit.
class RunParts : public PartedWork {
public:
    /// Begins the run in the folder of `options`, or takes it up with the cut that it was begun with. Throws
    /// InputError where another run lies there or is written there by one program, or where the program or
    /// the scene is not the one it was begun with; RunError.
    RunParts(const Scene& scene, const RunOptions& options, const RunCut& cut);

    std::vector<std::size_t> missing() override;
    /// Also throws InputError for a device that is not of the kind of those that computed the other parts.
    bool compute(Device& device, std::size_t part) override;
    bool merge() override;
    std::size_t count() const { return count_; }

private:
    std::size_t begin(const RunCut& cut);
    std::size_t size_of_finished_parts(std::size_t fitting) const;
    Scene scene_of(std::size_t part) const;
    void expect_own(std::size_t part) const;
    bool is_whole(std::size_t part) const;
    void warn_of_damage(std::size_t part, const std::string& why) const;
    std::filesystem::path take_work_folder(std::size_t part) const;
    RunEnd run_part(Device& device, std::size_t part, const std::filesystem::path& work);
    void expect_own_merge() const;
    bool merge_files();

    const Scene& scene_;
    RunOptions options_;
    FolderLock lock_;
    std::size_t part_replicas_ = 0, count_ = 0;
};

/// Whether a run lies in parts in this folder.
bool is_run_in_parts(const std::filesystem::path& folder);

}  // namespace mcdem::ensemble
