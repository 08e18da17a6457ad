#include "ensemble/share_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/make_folder.h"
#include "ensemble/agreement.h"
#include "ensemble/run_state.h"
#include "io/checkpoint.h"
#include "io/claims.h"
#include "io/csv.h"
#include "io/folder_lock.h"
#include "io/parts.h"
#include "io/result_file.h"
#include "io/result_folder.h"
#include "io/results.h"

namespace mcdem {
namespace {

namespace fs = std::filesystem;

constexpr double grains_that_fill_a_device = 32'768;
constexpr std::chrono::milliseconds shortest_pause{50}, longest_pause{2000};  // of one that waits for others
const char* const merging = "merge";

std::string part_name(std::size_t part) { return fmt::format("{:05}", part); }
fs::path agreement_file(const fs::path& folder) { return parts_folder(folder) / "agreement.json"; }
fs::path part_file(const fs::path& folder, std::size_t part) {
    return parts_folder(folder) / (part_name(part) + ".h5");
}

/// Parts no longer wanted, on their way out: the folder of the parts goes in one step.
fs::path old_parts(const fs::path& folder) { return folder / "parts.merged"; }

bool is_merged(const fs::path& folder) {
    return fs::exists(run_file(folder)) && !fs::exists(parts_folder(folder));
}

/// Which parts are done, by one look at the folder.
std::vector<bool> parts_there(const fs::path& folder, std::size_t parts) {
    std::vector<bool> there(parts, false);
    for (const auto& entry : fs::directory_iterator(parts_folder(folder))) {
        const std::string stem = entry.path().stem().string();
        if (entry.path().extension() != ".h5" || stem.empty() ||
            stem.find_first_not_of("0123456789") != stem.npos)
            continue;
        if (const std::size_t part = std::stoul(stem); part < parts) there[part] = true;
    }
    return there;
}

/// Grains of a replica, as far as a scene tells without its packing.
double grains_of(const Replica& replica) {
    if (const auto* drawn = std::get_if<GeneratedPacking>(&replica.packing.source)) return drawn->count;
    constexpr double bytes_of_a_grain = 50;  // about, in a packing file
    std::error_code missing;
    const auto bytes = fs::file_size(std::get<PackingFile>(replica.packing.source).path, missing);
    return missing ? 1 : std::max(1.0, static_cast<double>(bytes) / bytes_of_a_grain);
}

/// As many replicas as fill a device, but so few that every worker has two parts: the last to end is waited
/// for.
std::size_t fitting_part(const Scene& scene, const ShareOptions& options) {
    if (options.part_replicas > 0) return options.part_replicas;
    double most = 1;
    for (const Replica& replica : scene.replicas) most = std::max(most, grains_of(replica));
    const auto filling = static_cast<std::size_t>(std::max(1.0, grains_that_fill_a_device / most));
    const std::size_t shares = 2 * std::max<std::size_t>(1, options.workers);
    return std::clamp<std::size_t>((scene.replicas.size() + shares - 1) / shares, 1, filling);
}

/// Whether the finished parts are those of this run in parts of so many replicas.
bool are_parts_of(const std::map<std::size_t, Run>& parts, const Scene& scene, const Run& run,
                  std::size_t of_part) {
    for (const auto& [number, part] : parts) {
        const std::size_t first = number * of_part;
        if (part.scene != run.scene || part.program != run.program || part.device != run.device ||
            first >= scene.replicas.size() ||
            part.recordings.size() != std::min(of_part, scene.replicas.size() - first))
            return false;
        for (std::size_t r = 0; r < part.recordings.size(); ++r)
            if (part.recordings[r].label != scene.replicas[first + r].label) return false;
    }
    return true;
}

/// Where the agreement is damaged, the finished parts tell how large parts are: a size for that. Throws
/// InputError where they are another run's.
std::size_t size_of_parts(const fs::path& folder, const Scene& scene, const Run& run, std::size_t fitting) {
    std::map<std::size_t, Run> parts;
    const std::vector<bool> there = parts_there(folder, scene.replicas.size());
    for (std::size_t part = 0; part < there.size(); ++part)
        if (there[part]) parts.emplace(part, read_run_header({part_file(folder, part)}));
    if (are_parts_of(parts, scene, run, fitting)) return fitting;
    for (std::size_t size = 1; size <= scene.replicas.size(); ++size)
        if (are_parts_of(parts, scene, run, size)) return size;
    throw InputError(
        fmt::format("{}: is damaged, and the finished parts beside it are of another scene, program or "
                    "device: give that one, or another "
                    "folder",
                    agreement_file(folder).string()));
}

/// A number of replicas that was agreed on.
std::size_t number_in(const Common& chosen, const std::string& name, const fs::path& folder) {
    const auto found = chosen.find(name);
    const std::string text = found == chosen.end() ? "" : found->second;
    const bool digits = !text.empty() && text.size() < 10 && text.find_first_not_of("0123456789") == text.npos;
    if (const std::size_t number = digits ? std::stoul(text) : 0; number > 0) return number;
    throw InputError(fmt::format("{}: '{}' must be a number of replicas above 0, got '{}': restore it from a copy, or give "
                                 "another folder",
                                 agreement_file(folder).string(), name, text));
}

/// A worker on a run: what it shares with the others is the folder.
class Worker {
public:
    Worker(Device& device, const Scene& scene, const ShareOptions& options)
        : device_(device),
          scene_(scene),
          options_(options),
          claims_(parts_folder(options.folder), {device.info().index, device.info().name}) {
        std::size_t size = fitting_part(scene, options);
        if (const fs::path file = agreement_file(options.folder); is_damaged_agreement(file)) {
            size =
                size_of_parts(options.folder, scene,
                              {scene.name, scene.text, options.program, device.description(), {}, {}}, size);
            options.on_warning(
                fmt::format("{}: is damaged, and made anew from what is there", file.string()));
            fs::remove(file);
        }
        const auto chosen = agree(agreement_file(options.folder), common_of(device, scene, options.program),
                                  {{"replicas", std::to_string(scene.replicas.size())},
                                   {"replicas of a part", std::to_string(size)}});
        part_replicas_ = number_in(chosen, "replicas of a part", options.folder);
        parts_ = (scene.replicas.size() + part_replicas_ - 1) / part_replicas_;
    }

    RunEnd until_all_is_done() {
        auto pause = shortest_pause;
        while (!is_merged(options_.folder)) {
            if (options_.stop_wanted()) return RunEnd::interrupted;
            options_.on_tick();
            const auto claim = claims_.take_one_of(missing());
            if (!claim) {
                std::this_thread::sleep_for(pause);
                pause = std::min(2 * pause, longest_pause);
                continue;
            }
            pause = shortest_pause;
            claim->task() == merging ? merge() : compute(*claim);
        }
        return RunEnd::done;
    }

private:
    /// Names of the parts that nobody has finished; of the merge once there are none.
    std::vector<std::string> missing() const {
        if (fs::exists(run_file(options_.folder))) return {merging};  // .. which was cut short
        const std::vector<bool> there = parts_there(options_.folder, parts_);
        std::vector<std::string> names;
        for (std::size_t part = 0; part < parts_; ++part)
            if (!there[part]) names.push_back(part_name(part));
        if (names.empty()) names.emplace_back(merging);
        return names;
    }

    Scene scene_of(std::size_t part) const {
        Scene some = scene_;
        const auto first = static_cast<std::ptrdiff_t>(part * part_replicas_);
        const auto last =
            static_cast<std::ptrdiff_t>(std::min(scene_.replicas.size(), (part + 1) * part_replicas_));
        some.replicas.assign(scene_.replicas.begin() + first, scene_.replicas.begin() + last);
        return some;
    }

    /// The folder in which this holder of the part works, with what the one before has left, if anything. A
    /// holder that was taken for lost and comes back no longer finds its own, and does no harm.
    fs::path take_over(const Claim& claim) const {
        const auto work_folder = [&](int holder) {
            return parts_folder(options_.folder) / fmt::format("{}.work-{:06}", claim.task(), holder);
        };
        const fs::path mine = work_folder(claim.holder());
        for (int before = claim.holder() - 1; before > 0; --before)
            if (fs::exists(work_folder(before))) {
                fs::rename(work_folder(before), mine);
                break;
            }
        return mine;
    }

    void compute(Claim& claim) {
        const std::size_t part = std::stoul(claim.task());
        const fs::path result = part_file(options_.folder, part);
        if (fs::exists(result)) return;  // another has ended it between looking and taking
        const fs::path work = take_over(claim);
        if (run_part(scene_of(part), work, claim) == RunEnd::interrupted) return;
        move_file(run_file(work), result);
        fs::remove_all(work);
    }

    RunEnd run_part(const Scene& part, const fs::path& work, Claim& claim) {
        RunOptions run;
        run.folder = work;
        run.program = options_.program;
        run.on_progress = [&](double fraction) {
            claim.show(fraction);
            options_.on_tick();
        };
        run.on_failure = options_.on_failure;
        run.on_warning = options_.on_warning;
        run.stop_wanted = options_.stop_wanted;
        if (fs::exists(work)) try {
                run.start = Start::resume;
                return run_scene(device_, part, run).end;
            } catch (const InputError& error) {
                options_.on_warning(
                    fmt::format("part {} is computed anew: what was there of it is of no use: {}",
                                claim.task(), error.what()));
                fs::remove_all(work);
            }
        run.start = Start::fresh;
        return run_scene(device_, part, run).end;
    }

    /// Locks keep others away, but not on every network disk.
    void expect_own_merge() const {
        if (read_run_header({run_file(options_.folder)}).scene != scene_.text)
            throw InputError(
                options_.folder.string() +
                ": holds the run.h5 of another run beside the parts of this one: move one of them "
                "(run.h5 and plate.csv; parts/) elsewhere");
    }

    /// Parts may have been cut in another way before agreement.json was lost.
    void expect_own_replicas(std::size_t part, const fs::path& file) const try {
        const Run found = read_run_header({file});
        const Scene wanted = scene_of(part);
        if (!std::ranges::equal(found.recordings, wanted.replicas, {}, &Recording::label, &Replica::label))
            throw DamagedPart(part, file.string() + ": holds other replicas than part " + part_name(part));
    } catch (const InputError& error) {
        throw DamagedPart(part, error.what());
    }

    /// Safe to do twice, and after it was cut short anywhere.
    void merge() {
        if (fs::exists(run_file(options_.folder))) {
            expect_own_merge();
        } else {
            std::vector<fs::path> files;
            for (std::size_t part = 0; part < parts_; ++part)
                files.push_back(part_file(options_.folder, part));
            try {
                for (std::size_t part = 0; part < parts_; ++part) expect_own_replicas(part, files[part]);
                merge_parts(files, run_file(options_.folder));
            } catch (const DamagedPart& damaged) {
                options_.on_warning(
                    fmt::format("part {} is computed again: {}", part_name(damaged.part), damaged.what()));
                fs::remove(part_file(options_.folder, damaged.part));
                return;
            }
        }
        write_csv(read_run(options_.folder, ReadWhat::observables), options_.folder);
        fs::remove_all(old_parts(options_.folder));
        fs::rename(parts_folder(options_.folder), old_parts(options_.folder));
        fs::remove_all(old_parts(options_.folder));
        // Another that takes itself for the merger may still write: what it would write is there.
        remove_temporaries(options_.folder);
    }

    Device& device_;
    const Scene& scene_;
    const ShareOptions& options_;
    Claims claims_;
    std::size_t part_replicas_ = 0, parts_ = 0;
};

/// A run of one program in the folder is not touched: it is its own.
void expect_no_run_of_one(const fs::path& folder) {
    if (fs::exists(parts_folder(folder))) return;
    if (has_checkpoint(folder) || !segment_files(folder).empty())
        throw InputError(
            folder.string() +
            ": holds an interrupted run of one program: go on with it by --resume alone, or give "
            "another folder");
}

/// Keeps those away that write alone. What lies in the folder is looked at once they cannot come any more.
FolderLock lock_for_sharing(const fs::path& folder, const Scene& scene) {
    FolderLock lock(folder, FolderLock::Use::shared);
    expect_room_for_run(folder);
    expect_no_run_of_one(folder);
    if (is_merged(folder)) expect_scene_of(folder, scene);
    return lock;
}

}  // namespace

bool is_shared_run(const fs::path& folder) { return fs::exists(parts_folder(folder)); }

void expect_sharable(const fs::path& folder, const Scene& scene) {
    expect_no_file(folder);
    if (fs::exists(folder)) lock_for_sharing(folder, scene);
}

RunEnd share_run(Device& device, const Scene& scene, const ShareOptions& options) {
    make_result_folder(options.folder);
    const FolderLock lock = lock_for_sharing(options.folder, scene);
    if (is_merged(options.folder)) {
        fs::remove_all(old_parts(options.folder));
        remove_temporaries(options.folder);
        return RunEnd::was_done;
    }
    try {
        return Worker(device, scene, options).until_all_is_done();
    } catch (const std::exception&) {
        // The folder of the parts goes when others have merged them, whatever this worker was about to do
        // there.
        if (!is_merged(options.folder)) throw;
        expect_scene_of(options.folder, scene);
        return RunEnd::done;
    }
}

SharedState shared_state(const fs::path& folder) {
    SharedState state;
    state.done = is_merged(folder);
    if (state.done) state.fraction = 1;
    if (state.done || !fs::exists(agreement_file(folder))) return state;
    try {
        const Common chosen = read_chosen(agreement_file(folder));
        const std::size_t all = number_in(chosen, "replicas", folder);
        const std::size_t of_part = number_in(chosen, "replicas of a part", folder);
        const auto replicas = static_cast<double>(all);
        state.parts = (all + of_part - 1) / of_part;
        const auto under_way = Claims(parts_folder(folder)).under_way();
        const std::vector<bool> there = parts_there(folder, state.parts);
        for (std::size_t part = 0; part < state.parts; ++part) {
            const bool is_done = there[part];
            const auto held = under_way.find(part_name(part));
            state.parts_done += is_done;
            const double size =
                std::min(static_cast<double>(of_part), replicas - static_cast<double>(part * of_part));
            state.fraction += size / replicas * (is_done ? 1 : held == under_way.end() ? 0 : held->second);
        }
    } catch (const std::exception&) {
        state.done = is_merged(folder);  // merged while this looked
    }
    return state;
}

}  // namespace mcdem
