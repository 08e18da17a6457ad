#include "io/results.h"

#include <fmt/format.h>

#include <optional>

#include "core/errors.h"
#include "io/result_file.h"
#include "io/result_folder.h"

namespace mcdem::inline io {
namespace {

template <class Read>
auto guarded(const std::filesystem::path& file, Read read) {
    try {
        return read();
    } catch (const std::bad_alloc&) {
        throw RunError(file.string() + ": not enough memory; read it scan by scan, or on a larger machine");
    } catch (const std::length_error&) {
        throw InputError(file.string() + ": claims an impossible size; the file is damaged");
    }
}

void expect_same_run(const Run& run, const Run& next, const std::filesystem::path& file) {
    bool same = run.recordings.size() == next.recordings.size();
    for (std::size_t r = 0; same && r < run.recordings.size(); ++r)
        same = run.recordings[r].label == next.recordings[r].label &&
               run.recordings[r].diameter.size() == next.recordings[r].diameter.size();
    if (!same) throw InputError(file.string() + ": belongs to another run than the segments before it");
}

/// Adds the header of `file` to the run: everything from the first file, failures from later ones.
void add_header(Run& run, const ResultFile& file, const std::filesystem::path& path, bool is_first) {
    Run next = file.header();
    if (is_first) run = next;
    expect_same_run(run, next, path);
    for (std::size_t r = 0; r < run.recordings.size(); ++r)
        if (next.recordings[r].failure) run.recordings[r].failure = next.recordings[r].failure;
}

void add_file(Run& run, const ResultFile& file, const std::filesystem::path& path, ReadWhat what,
              bool is_first, const StopWanted& stop_wanted = never_stop) {
    add_header(run, file, path, is_first);
    for (std::size_t r = 0; r < run.recordings.size(); ++r) {
        if (stop_wanted()) throw Interrupted();
        auto scans = file.scans(run.recordings[r], r, what);
        auto& all = run.recordings[r].scans;
        all.insert(all.end(), std::make_move_iterator(scans.begin()), std::make_move_iterator(scans.end()));
    }
}

}  // namespace

Run read_run_header(const std::vector<std::filesystem::path>& files) {
    Run run;
    for (const auto& file : files) add_header(run, ResultFile(file), file, &file == &files.front());
    return run;
}

Run read_run(const std::filesystem::path& file_or_folder, ReadWhat what, const StopWanted& stop_wanted) {
    const auto files = result_files(file_or_folder);
    Run run;
    for (const auto& file : files)
        guarded(file,
                [&] { add_file(run, ResultFile(file), file, what, &file == &files.front(), stop_wanted); });
    return run;
}

const ResultFile& ResultFiles::open(std::size_t index) {
    constexpr std::size_t max_open_files = 100;
    if (open_[index]) return *open_[index];
    if (paths_.size() > max_open_files)
        for (auto& file : open_) file.reset();
    return open_[index].emplace(paths_[index]);
}

RunReader::RunReader(const std::filesystem::path& file_or_folder)
    : files_(std::make_unique<ResultFiles>(result_files(file_or_folder))) {
    const auto& paths = files_->paths();
    for (std::size_t f = 0; f < paths.size(); ++f) {
        std::vector<std::size_t> first;
        for (const auto& recording : run_.recordings) first.push_back(recording.scans.size());
        guarded(paths[f], [&] { add_file(run_, files_->open(f), paths[f], ReadWhat::observables, f == 0); });
        first.resize(run_.recordings.size(), 0);
        first_scan_.push_back(std::move(first));
    }
}

RunReader::~RunReader() = default;

Scan RunReader::read_scan(std::size_t replica, std::size_t scan) {
    const Recording& recording = run_.recordings.at(replica);
    Scan filled = recording.scans.at(scan);
    std::size_t f = first_scan_.size() - 1;
    while (first_scan_[f][replica] > scan) --f;
    guarded(files_->paths()[f], [&] {
        files_->open(f).fill(filled, recording.diameter.size(), replica, scan - first_scan_[f][replica]);
    });
    return filled;
}

}  // namespace mcdem::io
