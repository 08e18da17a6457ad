#include "io/result_folder.h"

#include <fmt/format.h>

#include <map>
#include <optional>

#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/look.h"
#include "core/make_folder.h"
#include "core/output_file.h"
#include "io/result_file.h"

namespace mcdem::inline io {
namespace {

namespace fs = std::filesystem;

fs::path segment_file(const fs::path& folder, int index) {
    return folder / fmt::format("segment-{:06}.h5", index);
}

std::optional<int> segment_index(const fs::path& file) {
    const std::string name = file.filename().string();
    int index = -1, length = 0;
    if (std::sscanf(name.c_str(), "segment-%6d.h5%n", &index, &length) != 1 || index < 0 ||
        length != static_cast<int>(name.size()))
        return std::nullopt;
    return index;
}

/// Whether it may be removed: a result file, not a link or a file of others with such a name.
bool is_segment(const fs::path& file) {
    try {
        return look_at_itself(file) == At::file && (ResultFile(file), true);
    } catch (const InputError&) {
        return false;
    }
}

bool belongs_to_a_run(const fs::path& file) {
    const std::string name = file.filename().string();
    return name == "run.h5" || name.starts_with("checkpoint.") || segment_index(file) ||
           file == parts_folder(file.parent_path());
}

/// Appends the scans of replica `r` of a file.
void append(ResultWriter& writer, const std::vector<Scan>& scans, StoredScans stored) {
    for (const Scan& scan : scans) stored.append(scan);
    writer.append(stored);
}

/// Replica by replica, so that only one replica of one segment is in memory.
void merge(const std::vector<fs::path>& files, const fs::path& merged, const StopWanted& stop_wanted) {
    const Run run = read_run_header(files);
    ResultFiles segments(files);
    const auto empty = stored_scans(run);
    const auto write = [&](ResultWriter& writer) {
        for (std::size_t r = 0; r < run.recordings.size(); ++r) {
            writer.begin(run.recordings[r]);
            for (std::size_t k = 0; k < files.size(); ++k)
                append(writer, segments.open(k).scans(run.recordings[r], r, ReadWhat::everything), empty[r]);
            writer.end(run.recordings[r].failure);
        }
    };
    write_result_file(merged, run, h5::Storage::compressed, write, stop_wanted);
}

/// Reads part `number`. Errors in its file are InputErrors, as for any other damaged file.
template <class Read>
auto from_part(std::size_t number, Read read) {
    try {
        return read();
    } catch (const InputError& error) {
        throw DamagedPart(number, error.what());
    }
}

}  // namespace

fs::path run_file(const fs::path& folder) { return folder / "run.h5"; }

std::vector<fs::path> segment_files(const fs::path& folder) {
    std::map<int, fs::path> found;
    for (const fs::path& entry : entries_of(folder))
        if (const auto index = segment_index(entry)) found[*index] = entry;
    std::vector<fs::path> files;
    for (const auto& [index, file] : found) {
        if (index != static_cast<int>(files.size()))
            throw InputError(fmt::format("{}: is missing, though later segments are there",
                                         segment_file(folder, static_cast<int>(files.size())).string()));
        files.push_back(file);
    }
    return files;
}

std::vector<fs::path> result_files(const fs::path& file_or_folder) {
    if (!is_there(file_or_folder))
        throw InputError(file_or_folder.string() + ": must be a result folder or file, got nothing there");
    if (!is_folder(file_or_folder)) return {file_or_folder};
    if (is_there(run_file(file_or_folder))) return {run_file(file_or_folder)};
    if (is_there(parts_folder(file_or_folder)))
        throw InputError(
            file_or_folder.string() +
            ": holds parts of a run that are not merged yet: wait for the programs that compute them, or "
            "continue with --resume (in Python resume=True)");
    const auto segments = segment_files(file_or_folder);
    if (segments.empty())
        throw InputError(file_or_folder.string() + ": holds no run (neither run.h5 nor segment-000000.h5)");
    return segments;
}

fs::path file_of_a_run(const fs::path& folder) {
    for (const fs::path& entry : entries_of(folder))
        if (belongs_to_a_run(entry)) return entry;
    return {};
}

void make_result_folder(const fs::path& folder) {
    if (is_there(folder) && !is_folder(folder))
        throw InputError(folder.string() + ": is a file; give a folder for the results");
    make_folder(folder);
}

ResultFolder ResultFolder::create(const fs::path& folder) {
    make_result_folder(folder);
    ResultFolder made(folder, FolderLock(folder, FolderLock::Use::alone));
    if (const fs::path file = file_of_a_run(folder); !file.empty())
        throw InputError(
            fmt::format("{}: already holds a run ({}): give another folder, or continue it with --resume (in "
                        "Python resume=True)",
                        folder.string(), file.filename().string()));
    return made;
}

ResultFolder ResultFolder::open_for_resume(const fs::path& folder) {
    if (!is_folder(folder)) throw InputError(folder.string() + ": no such folder, so nothing to resume");
    expect_writable(folder);
    ResultFolder found(folder, FolderLock(folder, FolderLock::Use::alone));
    if (is_there(parts_folder(folder)))
        throw InputError(
            folder.string() +
            ": holds parts of a run: continue with `mcdem run .. --resume`, or give another folder");
    if (found.is_finished()) {
        found.remove_segments();  // left by a finish() that was interrupted after its last write
    } else {
        found.segments_ = static_cast<int>(segment_files(folder).size());
    }
    return found;
}

bool ResultFolder::is_finished() const { return is_there(run_file(folder_)); }

void ResultFolder::append_segment(const Run& header, const std::vector<StoredScans>& scans_since_last) {
    write_run(segment_file(folder_, segments_), header, scans_since_last, h5::Storage::plain);
    ++segments_;
}

void ResultFolder::finish(const Run& header, const std::vector<StoredScans>& all_scans) {
    expect_alone();
    write_run(run_file(folder_), header, all_scans, h5::Storage::compressed);
}

void ResultFolder::drop_segments_from(int index) {
    // The last one first, so that a crash in between leaves no gap.
    for (; segments_ > index; --segments_) {
        const fs::path file = segment_file(folder_, segments_ - 1);
        if (!is_segment(file))
            throw InputError(file.string() +
                             ": is not a segment of a run, and is not removed: move it elsewhere");
        fs::remove(file);
    }
}

void ResultFolder::expect_whole_segments(const StopWanted& stop_wanted) const {
    try {
        const auto files = segment_files(folder_);
        if (files.empty()) return;
        const Run run = read_run_header(files);
        for (const auto& file : files) {
            const ResultFile segment(file);
            for (std::size_t r = 0; r < run.recordings.size(); ++r) {
                if (stop_wanted()) throw Interrupted();
                segment.scans(run.recordings[r], r, ReadWhat::everything);
            }
        }
    } catch (const InputError& error) {
        throw InputError(
            fmt::format("{}; a run with missing scans cannot be resumed: start it again in another folder",
                        error.what()));
    }
}

void ResultFolder::remove_segments() {
    for (const fs::path& entry : entries_of(folder_))
        if (segment_index(entry) && is_segment(entry)) fs::remove(entry);
    segments_ = 0;
}

void ResultFolder::finish(const StopWanted& stop_wanted) {
    const auto segments = segment_files(folder_);
    if (segments.empty()) throw RunError(folder_.string() + ": nothing was recorded");
    expect_alone();
    merge(segments, run_file(folder_), stop_wanted);
    remove_segments();
}

void ResultFolder::expect_alone() const {
    // Locks exclude others, but not on every network file system.
    if (is_there(run_file(folder_)) || is_there(parts_folder(folder_)))
        throw RunError(
            folder_.string() +
            ": another program has begun a run there meanwhile: both are left as they are; move one "
            "of them (segments and checkpoints; parts/, run.h5 and plate.csv) elsewhere");
}

fs::path parts_folder(const fs::path& folder) { return folder / "parts"; }

void merge_parts(const std::vector<fs::path>& parts, const fs::path& merged, const StopWanted& stop_wanted) {
    Run all;
    std::vector<std::size_t> first{0};  // replica of each part
    for (std::size_t p = 0; p < parts.size(); ++p) {
        if (stop_wanted()) throw Interrupted();
        Run part = from_part(p, [&] { return read_run_header({parts[p]}); });
        if (p == 0)
            all = std::move(part);
        else
            std::ranges::move(part.recordings, std::back_inserter(all.recordings));
        first.push_back(all.recordings.size());
    }
    const auto empty = stored_scans(all);
    const auto write = [&](ResultWriter& writer) {
        for (std::size_t p = 0; p < parts.size(); ++p) {
            const ResultFile file = from_part(p, [&] { return ResultFile(parts[p]); });
            for (std::size_t r = first[p]; r < first[p + 1]; ++r) {
                auto scans = from_part(
                    p, [&] { return file.scans(all.recordings[r], r - first[p], ReadWhat::everything); });
                writer.begin(all.recordings[r]);
                append(writer, scans, empty[r]);
                writer.end(all.recordings[r].failure);
            }
        }
    };
    write_result_file(merged, all, h5::Storage::compressed, write, stop_wanted);
}

}  // namespace mcdem::io
