// The folder of a run: segments while it runs, or the parts of a distributed run, one file at the end. Output
// folders of other commands.
#pragma once
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "core/recording.h"
#include "core/stop.h"
#include "io/folder_lock.h"
#include "io/result_rows.h"

namespace mcdem::inline io {

/// `<folder>/run.h5`: the complete run; exists when the run is finished.
std::filesystem::path run_file(const std::filesystem::path& folder);

/// The segments of an unfinished run, in order. Throws InputError if one is missing.
std::vector<std::filesystem::path> segment_files(const std::filesystem::path& folder);

/// The files that `read_run` reads for `file_or_folder`: the file itself, run.h5, or all segments.
/// Throws InputError if there is nothing, or no run.
std::vector<std::filesystem::path> result_files(const std::filesystem::path& file_or_folder);

/// A file of a run in any state in the folder; an empty path if there is none.
std::filesystem::path file_of_a_run(const std::filesystem::path& folder);

/// Like make_folder, but a file at this path is an InputError.
void make_result_folder(const std::filesystem::path& folder);

/// Exclusive owner of a result folder while a run is written; other programs are refused.
class ResultFolder {
public:
    /// Creates the folder. Refuses one that contains another run.
    static ResultFolder create(const std::filesystem::path& folder);
    /// Opens the folder of a run that was interrupted, or is finished (see is_finished).
    static ResultFolder open_for_resume(const std::filesystem::path& folder);

    const std::filesystem::path& path() const { return folder_; }
    int segments() const { return segments_; }
    bool is_finished() const;

    // Those with `stop_wanted` throw Interrupted, and leave the folder as it is, if it becomes true
    // meanwhile.

    /// Writes the scans since the last segment, with the header of the run. Segments are not compressed: they
    /// are merged soon.
    void append_segment(const Run& header, const std::vector<StoredScans>& scans_since_last);
    /// Discards segment `index` and all later ones, which are newer than the checkpoint.
    void drop_segments_from(int index);
    /// Reads all segments. Throws InputError with the damaged one and a remedy.
    void expect_whole_segments(const StopWanted& stop_wanted) const;
    /// Merges all segments into run.h5 and removes them. Needs memory for one segment.
    void finish(const StopWanted& stop_wanted = never_stop);
    /// Writes run.h5 of a run without segments.
    void finish(const Run& header, const std::vector<StoredScans>& all_scans);

private:
    ResultFolder(std::filesystem::path folder, FolderLock lock)
        : folder_(std::move(folder)), lock_(std::move(lock)) {}
    void remove_segments();
    void expect_alone() const;
    std::filesystem::path folder_;
    FolderLock lock_;
    int segments_ = 0;  ///< number of the next segment
};

/// Folder of the parts of the run in `folder` until they are merged.
std::filesystem::path parts_folder(const std::filesystem::path& folder);

/// A part that cannot be read completely and must be computed again.
struct DamagedPart : std::runtime_error {
    DamagedPart(std::size_t number, const std::string& why) : std::runtime_error(why), part(number) {}
    std::size_t part;
};

/// Writes the replicas of all parts in order into `merged`; the file is bit-identical to that of a single
/// process. Holds one replica in memory. Throws Interrupted, and leaves no file, if `stop_wanted` becomes
/// true meanwhile; DamagedPart, and RunError if `merged` cannot be written.
void merge_parts(const std::vector<std::filesystem::path>& parts, const std::filesystem::path& merged,
                 const StopWanted& stop_wanted = never_stop);

}  // namespace mcdem::io
