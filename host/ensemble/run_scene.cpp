#include "ensemble/run_scene.h"

#include <chrono>

#include "core/errors.h"
#include "core/look.h"
#include "core/output_file.h"
#include "ensemble/make_packings.h"
#include "ensemble/run_state.h"
#include "io/csv.h"
#include "io/results.h"
#include "sim/batch_limits.h"
#include "sim/simulation.h"

namespace mcdem::inline ensemble {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Maximum size of scans in memory; beyond it they are written to disk before the next checkpoint is due.
constexpr std::size_t max_bytes_held = std::size_t{256} << 20;

std::size_t bytes_of(const Scan& scan) {
    return sizeof(Scan) + (scan.position.size() + scan.rotation.size()) * sizeof(Vec3) +
           scan.contacts.size() * sizeof(Contact);
}

/// A run in progress: the simulation, its folder, and the data recorded since the last segment.
class RunSession {
public:
    RunSession(Device& device, const Scene& scene, const std::vector<Packing>& packings,
               const RunOptions& options, ResultFolder folder)
        : scene_(scene),
          options_(options),
          identity_(identity_of(device, scene, options.program, packings)),
          folder_(std::move(folder)),
          simulation_(device, scene, packings) {
        pending_ = {
            scene.name, scene.text, options.program, device.description(), std::string(name(scene.precision)),
            {}};
        for (std::size_t r = 0; r < packings.size(); ++r)
            pending_.recordings.push_back(begin_recording(scene.replicas[r], packings[r]));
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
            if (checkpoint_due() || !more || stop) write_checkpoint();
        }
        if (!more) folder_.finish(options_.stop_wanted);
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
        attempt([&] { simulation_.pass_on(keep_, note_); });
        attempt([&] {
            if (anything_new_) folder_.append_segment(pending_);
        });
    }

    void keep(int replica, Scan scan) {
        bytes_held_ += bytes_of(scan);
        anything_new_ = true;
        pending_.recordings[replica].scans.push_back(std::move(scan));
    }

    void note(int replica, const Failure& failure) {
        anything_new_ = true;
        pending_.recordings[replica].failure = failure;
        options_.on_failure(scene_.replicas[replica], failure);
    }

    /// Runs whose checkpoints take long write fewer, so that they take a small fraction of the time.
    bool checkpoint_due() const {
        const double rest = checkpoint_seconds_ > 1 ? 20 * checkpoint_seconds_ : 0;
        const double interval = std::max(60 * scene_.output.checkpoint_minutes, rest);
        return seconds_since(last_checkpoint_) >= interval || bytes_held_ >= max_bytes_held;
    }

    void write_segment() {
        folder_.append_segment(pending_);
        for (auto& recording : pending_.recordings) {
            recording.scans.clear();
            recording.failure.reset();
        }
        anything_new_ = false;
        bytes_held_ = 0;
    }

    /// Writes the segment first, then the checkpoint that names it. A crash in between leaves one segment too
    /// many, which resume() discards.
    void write_checkpoint() {
        const auto start = Clock::now();
        simulation_.pass_on(keep_, note_);
        if (anything_new_ || folder_.segments() == 0) write_segment();
        mcdem::write_checkpoint(folder_.path(),
                                make_checkpoint(identity_, folder_.segments(), simulation_.save()));
        checkpoint_seconds_ = seconds_since(start);
        last_checkpoint_ = Clock::now();
    }

    const Scene& scene_;
    const RunOptions& options_;
    RunIdentity identity_;
    ResultFolder folder_;
    Simulation simulation_;
    const Simulation::ScanSink keep_ = [this](int r, Scan& scan) { keep(r, std::move(scan)); };
    const Simulation::FailureSink note_ = [this](int r, const Failure& failure) { note(r, failure); };
    Run pending_;                ///< provenance, and the scans since the last segment
    bool anything_new_ = false;  ///< in pending_
    std::size_t bytes_held_ = 0;
    Clock::time_point last_checkpoint_;
    double checkpoint_seconds_ = 0;  ///< duration of the last one
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
