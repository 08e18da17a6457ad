// A run in parts, which are ranges of replicas (README.md in the parent folder).
#pragma once
#include "ensemble/parts/parted_work.h"
#include "ensemble/run_scene.h"
#include "io/folder_lock.h"

namespace mcdem::inline ensemble {

/// Division of a run into parts.
struct RunCut {
    std::size_t part_replicas =
        0;  ///< replicas per part; 0: enough to fill a device, but at least two parts per worker
    std::size_t workers = 1;  ///< number of expected workers
};

/// After merging, the folder is bit-identical to the result of run_scene.
class RunParts : public PartedWork {
public:
    /// Starts the run in the folder of `options`, or continues it with its original division. Throws
    /// InputError if the folder contains another run or is locked by a single process, or if the program or
    /// the scene differ from the original ones; RunError.
    RunParts(const Scene& scene, const RunOptions& options, const RunCut& cut);

    std::size_t count() override { return count_; }
    std::vector<std::size_t> missing() override;
    /// Also throws InputError if the device is of another kind than those that computed the other parts.
    void compute(Device& device, std::size_t part) override;
    bool merge() override;

private:
    std::size_t begin(const RunCut& cut);
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

/// Whether the folder contains a run in parts.
bool is_run_in_parts(const std::filesystem::path& folder);

}  // namespace mcdem::ensemble
