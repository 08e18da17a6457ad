#include "ensemble/run_scene.h"

#include <chrono>
#include <future>
#include <utility>

#include "core/errors.h"
#include "core/look.h"
#include "core/output_file.h"
#include "ensemble/make_packings.h"
#include "ensemble/run_state.h"
#include "io/csv.h"
#include "io/result_folder.h"
#include "sim/batch_limits.h"
#include "sim/simulation.h"

namespace mcdem::inline ensemble {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Maximum size of scans in memory; beyond it they are written to disk before the next checkpoint is due,
/// while as many are collected.
constexpr std::size_t max_bytes_held = std::size_t{256} << 20;

/// A run in progress: the simulation, its folder, and the data recorded since the last segment. A thread
/// writes segments and checkpoints, so that the device does not wait for the disk.
class RunSession {
public:
    RunSession(Device& device, const Scene& scene, const std::vector<Packing>& packings,
               const RunOptions& options, ResultFolder folder)
        : scene_(scene),
          options_(options),
          identity_(identity_of(device, scene, options.program, packings)),
          folder_(std::move(folder)),
          simulation_(device, scene, packings) {
        header_ = {
            scene.name, scene.text, options.program, device.description(), std::string(name(scene.precision)),
            {}};
        for (std::size_t r = 0; r < packings.size(); ++r)
            header_.recordings.push_back(begin_recording(scene.replicas[r], packings[r]));
        scans_ = in_writing_ = stored_scans(header_);
    }

    /// Returns to the last checkpoint, or to the start if there is none.
    void resume() {
        const auto checkpoint = find_checkpoint(folder_, identity_, options_.on_warning);
        folder_.drop_segments_from(checkpoint ? checkpoint->segments : 0);
        if (!checkpoint) return;
        folder_.expect_whole_segments(options_.stop_wanted);
        simulation_.restore(checkpoint->fields);
    }

    RunSummary run() {
        try {
            return make_steps();
        } catch (...) {
            keep_what_is_recorded();
            throw;
        }
    }

private:
    RunSummary make_steps() {
        const auto start = Clock::now();
        last_checkpoint_ = start;
        bool more = true, stop = false;
        while (more && !stop) {
            more = simulation_.advance(keep_, note_);
            options_.on_progress(simulation_.progress());
            stop = options_.stop_wanted();
            if (writing_.valid() && writing_.wait_for(0s) == std::future_status::ready) finish_writing();
            if (more && !stop && checkpoint_due()) begin_checkpoint();
        }
        finish_writing();
        if (more || folder_.segments() > 0) {
            begin_checkpoint();
            finish_writing();
            if (!more) folder_.finish(options_.stop_wanted);
        } else {
            simulation_.pass_on(keep_, note_);
            folder_.finish(header_, scans_);
        }
        return {!more ? RunEnd::done : RunEnd::interrupted, simulation_.grain_steps(), seconds_since(start)};
    }

    /// Called when the device or the disk has failed: writes the data recorded since the last checkpoint, if
    /// there is space, so that they can be read. Resuming discards and computes them again.
    void keep_what_is_recorded() noexcept {
        const auto attempt = [](auto work) {
            try {
                work();
            } catch (const std::exception&) {  // only the first error is reported
            }
        };
        attempt([&] { finish_writing(); });
        attempt([&] { simulation_.pass_on(keep_, note_); });
        attempt([&] {
            if (holds_any(in_writing_)) folder_.append_segment(header_, in_writing_);
            if (anything_new_) folder_.append_segment(header_, scans_);
        });
    }

    static bool holds_any(const std::vector<StoredScans>& scans) {
        return std::ranges::any_of(scans, [](const auto& one) { return one.count() > 0; });
    }

    void keep(int replica, const Scan& scan) {
        StoredScans& scans = scans_[static_cast<std::size_t>(replica)];
        bytes_held_ -= scans.bytes();
        scans.append(scan);
        bytes_held_ += scans.bytes();
        anything_new_ = true;
    }

    void note(int replica, const Failure& failure) {
        anything_new_ = true;
        header_.recordings[static_cast<std::size_t>(replica)].failure = failure;
        options_.on_failure(scene_.replicas[static_cast<std::size_t>(replica)], failure);
    }

    /// Runs whose checkpoints take long write fewer, so that they take a small fraction of the time.
    bool checkpoint_due() const {
        const double rest = checkpoint_seconds_ > 1 ? 20 * checkpoint_seconds_ : 0;
        const double interval = std::max(60 * scene_.output.checkpoint_minutes, rest);
        return seconds_since(last_checkpoint_) >= interval || bytes_held_ >= max_bytes_held;
    }

    /// The thread writes the segment first, then the checkpoint that names it. A crash in between leaves one
    /// segment too many, which resume() discards.
    void begin_checkpoint() {
        finish_writing();
        simulation_.pass_on(keep_, note_);
        const bool has_segment = std::exchange(anything_new_, false) || folder_.segments() == 0;
        auto checkpoint = make_checkpoint(identity_, folder_.segments() + has_segment, simulation_.save());
        std::swap(scans_, in_writing_);
        bytes_held_ = 0;
        last_checkpoint_ = Clock::now();
        writing_ = std::async(std::launch::async,
                              [this, has_segment, header = header_, checkpoint = std::move(checkpoint)] {
                                  const auto start = Clock::now();
                                  if (has_segment) folder_.append_segment(header, in_writing_);
                                  for (StoredScans& scans : in_writing_) scans.clear();
                                  mcdem::write_checkpoint(folder_.path(), checkpoint);
                                  return seconds_since(start);
                              });
    }

    /// Waits for the thread. Throws what it has thrown.
    void finish_writing() {
        if (writing_.valid()) checkpoint_seconds_ = writing_.get();
    }

    const Scene& scene_;
    const RunOptions& options_;
    RunIdentity identity_;
    ResultFolder folder_;
    Simulation simulation_;
    const Simulation::ScanSink keep_ = [this](int r, const Scan& scan) { keep(r, scan); };
    const Simulation::FailureSink note_ = [this](int r, const Failure& failure) { note(r, failure); };
    Run header_;                                   ///< provenance and recordings, without scans
    bool anything_new_ = false;                    ///< scans or failures since the last segment
    std::vector<StoredScans> scans_, in_writing_;  ///< since the last segment, and those of that segment
    std::size_t bytes_held_ = 0;
    Clock::time_point last_checkpoint_;
    double checkpoint_seconds_ = 0;  ///< duration of the last one
    std::future<double> writing_;    ///< declared last, so it is waited for before the rest ends
};

/// Work after run.h5 is complete; it can be repeated safely.
void close_folder(const RunOptions& options) {
    write_csv(options.folder, options.stop_wanted);
    remove_checkpoint(options.folder);
}

ResultFolder open_folder(const RunOptions& options) {
    return options.start == Start::fresh ? ResultFolder::create(options.folder)
                                         : ResultFolder::open_for_resume(options.folder);
}

}  // namespace

RunSummary run_scene(Device& device, const Scene& scene, const RunOptions& options) try {
    expect_no_experiment(options.folder);
    if (!is_there(run_file(options.folder))) expect_runnable(device, scene);
    ResultFolder folder = open_folder(options);
    expect_room_for_run(folder.path());
    if (folder.is_finished()) {
        expect_scene_of(folder.path(), scene);
        close_folder(options);
        return {RunEnd::was_done};
    }
    const auto packings = make_packings(scene, options.stop_wanted);
    RunSession session(device, scene, packings, options, std::move(folder));
    if (options.start == Start::resume) session.resume();
    const RunSummary summary = session.run();
    if (summary.end == RunEnd::done) close_folder(options);
    return summary;
} catch (const Interrupted&) {
    return {RunEnd::interrupted};
}

}  // namespace mcdem::ensemble
