// The folder of a run: segments while it runs, one file when it is done.
#pragma once
#include <filesystem>
#include <vector>

#include "core/recording.h"
#include "io/folder_lock.h"

namespace mcdem::inline io {

/// `<folder>/run.h5`: the whole run, there once it is done.
std::filesystem::path run_file(const std::filesystem::path& folder);

/// The segments of a run in progress in order. Throws InputError when one is missing among them.
std::vector<std::filesystem::path> segment_files(const std::filesystem::path& folder);

/// What `read_run` reads for `file_or_folder`: the file itself, run.h5, or all segments.
std::vector<std::filesystem::path> result_files(const std::filesystem::path& file_or_folder);

/// A file of a run in the folder, of any state; an empty path where there is none.
std::filesystem::path file_of_a_run(const std::filesystem::path& folder);

/// Throws InputError for a file where the folder of a run is to be.
void expect_no_file(const std::filesystem::path& folder);

/// make_folder, but for a file in its place: InputError.
void make_result_folder(const std::filesystem::path& folder);

/// Owns a result folder while a run is written to it alone; other programs are refused.
class ResultFolder {
public:
    /// Makes the folder. Refuses one in which another run lies.
    static ResultFolder create(const std::filesystem::path& folder);
    /// Takes up the folder of a run that was interrupted (or is done: see is_finished).
    static ResultFolder open_for_resume(const std::filesystem::path& folder);

    const std::filesystem::path& path() const { return folder_; }
    int segments() const { return segments_; }
    bool is_finished() const;

    /// Writes the scans since the last segment, with all else about the run; returns the segment's number.
    int append_segment(const Run& scans_since_last);
    /// Forgets segment `index` and all later ones: they are newer than the checkpoint.
    void drop_segments_from(int index);
    /// Reads all segments. Throws InputError that says which is damaged and what to do.
    void expect_whole_segments() const;
    /// Merges all segments into run.h5 and removes them. Needs memory for one segment.
    void finish();

private:
    ResultFolder(std::filesystem::path folder, FolderLock lock)
        : folder_(std::move(folder)), lock_(std::move(lock)) {}
    void remove_segments();
    std::filesystem::path folder_;
    FolderLock lock_;
    int segments_ = 0;  ///< the next segment's number
};

}  // namespace mcdem::io
