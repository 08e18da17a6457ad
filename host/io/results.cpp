#include "io/results.h"

#include <fmt/format.h>

#include "core/errors.h"
#include "io/result_file.h"
#include "io/result_folder.h"

namespace mcdem {
namespace {

/// Memory that a damaged file asks for and cannot be had is the file's fault.
template <class Read>
auto guarded(const std::filesystem::path& file, Read read) {
    try {
        return read();
    } catch (const std::bad_alloc&) {
        throw InputError(file.string() +
                         ": needs more memory than there is; read it scan by scan, or on a larger "
                         "machine");
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

/// Takes what `file` says of the run: all of it from the first file, failures from later ones.
void add_header(Run& run, const ResultFile& file, const std::filesystem::path& path, bool is_first) {
    Run next = file.header();
    if (is_first) run = next;
    expect_same_run(run, next, path);
    for (std::size_t r = 0; r < run.recordings.size(); ++r)
        if (next.recordings[r].failure) run.recordings[r].failure = next.recordings[r].failure;
}

void add_file(Run& run, const std::filesystem::path& path, ReadWhat what, bool is_first) {
    const ResultFile file(path);
    add_header(run, file, path, is_first);
    for (std::size_t r = 0; r < run.recordings.size(); ++r) {
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

Run read_run(const std::filesystem::path& file_or_folder, ReadWhat what) {
    Run run;
    const auto files = result_files(file_or_folder);
    for (const auto& file : files) guarded(file, [&] { add_file(run, file, what, &file == &files.front()); });
    return run;
}

class RunReader::ResultFileOwner {
public:
    ResultFileOwner(const std::filesystem::path& path, std::size_t index) : file(path), index(index) {}
    ResultFile file;
    std::size_t index;
};

RunReader::RunReader(const std::filesystem::path& file_or_folder) : files_(result_files(file_or_folder)) {
    for (std::size_t f = 0; f < files_.size(); ++f) {
        std::vector<std::size_t> first;
        for (const auto& recording : run_.recordings) first.push_back(recording.scans.size());
        guarded(files_[f], [&] { add_file(run_, files_[f], ReadWhat::observables, f == 0); });
        first.resize(run_.recordings.size(), 0);
        first_scan_.push_back(std::move(first));
    }
}

RunReader::~RunReader() = default;

Scan RunReader::read_scan(std::size_t replica, std::size_t scan) {
    const Recording& recording = run_.recordings.at(replica);
    Scan filled = recording.scans.at(scan);
    std::size_t f = files_.size() - 1;
    while (first_scan_[f][replica] > scan) --f;
    if (!open_ || open_->index != f) open_ = std::make_unique<ResultFileOwner>(files_[f], f);
    guarded(files_[f], [&] {
        open_->file.fill(filled, recording.diameter.size(), replica, scan - first_scan_[f][replica]);
    });
    return filled;
}

}  // namespace mcdem
