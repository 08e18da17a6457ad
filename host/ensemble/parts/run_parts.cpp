#include "ensemble/parts/run_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/look.h"
#include "core/make_folder.h"
#include "ensemble/parts/manifest.h"
#include "ensemble/run_state.h"
#include "io/checkpoint.h"
#include "io/csv.h"
#include "io/result_file.h"
#include "io/result_folder.h"
#include "io/results.h"

namespace mcdem::inline ensemble {
namespace {

namespace fs = std::filesystem;

constexpr double grains_that_fill_a_device = 32'768;
const char* const size_of_part = "replicas of a part";

std::string part_name(std::size_t part) { return fmt::format("{:05}", part); }
fs::path part_file(const fs::path& folder, std::size_t part) {
    return parts_folder(folder) / (part_name(part) + ".h5");
}
std::string work_prefix(std::size_t part) { return part_name(part) + ".work-"; }

/// Merged parts before their removal: the folder of the parts is renamed in one step.
fs::path old_parts(const fs::path& folder) { return folder / "parts.merged"; }

/// Whether a file in the folder of the parts is of this work, by its name.
bool belongs_to_parts(const fs::path& folder, const fs::path& file) {
    const std::string name = file.filename().string();
    const std::size_t digits = std::min(name.find_first_not_of("0123456789"), name.size());
    const std::string_view ending = std::string_view(name).substr(digits);
    return file == manifest_file(folder) || file == device_file(folder) ||
           (digits >= 5 && (ending == ".h5" || ending.starts_with(".work-")));
}

/// Removes merged parts. Files of others are kept, with their folder, and what is behind a link is not
/// touched.
void remove_parts(const fs::path& folder) {
    if (look_at_itself(folder) == At::folder) {
        remove_temporaries(folder);
        for (const fs::path& file : entries_of(folder))
            if (belongs_to_parts(folder, file)) fs::remove_all(file);
    }
    std::error_code not_empty;
    fs::remove(folder, not_empty);
}

bool is_merged(const fs::path& folder) {
    return is_there(run_file(folder)) && !is_there(parts_folder(folder));
}

/// Number of grains of a replica, as far as a scene determines it without its packing.
double grains_of(const Replica& replica) {
    if (const auto* drawn = std::get_if<GeneratedPacking>(&replica.packing.source)) return drawn->count;
    constexpr double bytes_of_a_grain = 50;  // approximate, in a packing file
    const fs::path& file = std::get<PackingFile>(replica.packing.source).path;
    const auto bytes = is_file(file) ? size_of_file(file) : 0;  // reading reports that it is missing
    return std::max(1.0, static_cast<double>(bytes) / bytes_of_a_grain);
}

/// As many replicas as fill a device, but at most so many that every worker has two parts, to shorten the
/// wait for the last one.
std::size_t fitting_size(const Scene& scene, const RunCut& cut) {
    if (cut.part_replicas > 0) return cut.part_replicas;
    double most = 1;
    for (const Replica& replica : scene.replicas) most = std::max(most, grains_of(replica));
    const auto filling = static_cast<std::size_t>(std::max(1.0, grains_that_fill_a_device / most));
    const std::size_t shares = 2 * std::max<std::size_t>(1, cut.workers);
    return std::clamp<std::size_t>((scene.replicas.size() + shares - 1) / shares, 1, filling);
}

/// The size of parts in a manifest.
std::size_t size_in(const Manifest& kept, const fs::path& file) {
    const auto found = kept.find(size_of_part);
    const std::string text = found == kept.end() ? "" : found->second;
    const bool digits =
        !text.empty() && text.size() < 10 && text.find_first_not_of("0123456789") == text.npos;
    if (const std::size_t number = digits ? std::stoul(text) : 0; number > 0) return number;
    throw InputError(
        fmt::format("{}: '{}' must be a number of replicas above 0, got '{}': restore it from a copy, or "
                    "give another folder",
                    file.string(), size_of_part, text));
}

/// Throws if the folder contains a run of a single process.
void expect_no_run_of_one(const fs::path& folder) {
    if (is_there(parts_folder(folder))) return;
    if (has_checkpoint(folder) || !segment_files(folder).empty())
        throw InputError(folder.string() +
                         ": holds an interrupted run of one program: continue it by --resume alone, or give "
                         "another folder");
}

/// Excludes processes that work alone, and then checks the content of the folder.
FolderLock lock_for_sharing(const fs::path& folder, const Scene& scene) {
    make_result_folder(folder);
    FolderLock lock(folder, FolderLock::Use::shared);
    expect_room_for_run(folder);
    expect_no_run_of_one(folder);
    if (is_merged(folder)) expect_scene_of(folder, scene);
    return lock;
}

}  // namespace

bool is_run_in_parts(const fs::path& folder) { return is_there(parts_folder(folder)); }

RunParts::RunParts(const Scene& scene, const RunOptions& options, const RunCut& cut)
    : scene_(scene), options_(options), lock_(lock_for_sharing(options.folder, scene)) {
    if (is_merged(options.folder)) {
        remove_parts(old_parts(options.folder));
        remove_temporaries(options.folder);
        return;
    }
    part_replicas_ = begin(cut);
    count_ = (scene.replicas.size() + part_replicas_ - 1) / part_replicas_;
}

/// The size of parts with which the folder was started.
std::size_t RunParts::begin(const RunCut& cut) {
    const fs::path folder = parts_folder(options_.folder), file = manifest_file(folder);
    make_folder(folder);
    Manifest wanted = manifest_of(scene_, options_.program);
    wanted["number of replicas"] = std::to_string(scene_.replicas.size());
    wanted[size_of_part] = std::to_string(fitting_size(scene_, cut));
    return size_in(keep_manifest(file, wanted, size_of_part), file);
}

std::vector<std::size_t> RunParts::missing() {
    std::vector<std::size_t> parts;
    if (is_there(run_file(options_.folder))) return parts;
    for (std::size_t part = 0; part < count_; ++part)
        if (!is_there(part_file(options_.folder, part))) parts.push_back(part);
    // .. unless another process has merged all of them in the meantime.
    if (is_there(run_file(options_.folder))) parts.clear();
    return parts;
}

Scene RunParts::scene_of(std::size_t part) const {
    Scene some = scene_;
    const auto first = static_cast<std::ptrdiff_t>(part * part_replicas_);
    const auto last =
        static_cast<std::ptrdiff_t>(std::min(scene_.replicas.size(), (part + 1) * part_replicas_));
    some.replicas.assign(scene_.replicas.begin() + first, scene_.replicas.begin() + last);
    return some;
}

/// Throws DamagedPart if the finished part cannot be read, or belongs to something else.
void RunParts::expect_own(std::size_t part) const try {
    const fs::path file = part_file(options_.folder, part);
    const Run found = read_run_header({file});
    if (found.scene != scene_.text || !std::ranges::equal(found.recordings, scene_of(part).replicas, {},
                                                          &Recording::label, &Replica::label))
        throw DamagedPart(part, file.string() + ": holds other replicas than part " + part_name(part));
} catch (const InputError& error) {
    throw DamagedPart(part, error.what());
}

bool RunParts::is_whole(std::size_t part) const try {
    if (!is_there(part_file(options_.folder, part))) return false;
    expect_own(part);
    ResultFile(part_file(options_.folder, part)).expect_whole();
    return true;
} catch (const DamagedPart& damaged) {
    warn_of_damage(part, damaged.what());
    return false;
} catch (const InputError& error) {
    warn_of_damage(part, error.what());
    return false;
}

void RunParts::warn_of_damage(std::size_t part, const std::string& why) const {
    options_.on_warning(fmt::format("part {} is computed again: {}", part_name(part), why));
}

/// A work folder of this process for the part, with the checkpoint of an interrupted process, if there is
/// one. A process on another machine whose lock is not visible here finds its folder missing, and does no
/// harm.
fs::path RunParts::take_work_folder(std::size_t part) const {
    std::random_device random;
    const fs::path mine =
        parts_folder(options_.folder) / fmt::format("{}{:08x}{:08x}", work_prefix(part), random(), random());
    for (const fs::path& entry : entries_of(parts_folder(options_.folder))) {
        if (!entry.filename().string().starts_with(work_prefix(part))) continue;
        try {
            const FolderLock free(entry, FolderLock::Use::alone);
            std::error_code gone;
            fs::rename(entry, mine, gone);
            if (!gone) break;
        } catch (const InputError&) {  // another process is working there
        } catch (const RunError&) {
            if (is_there(entry)) throw;
        }
    }
    return mine;
}

RunEnd RunParts::run_part(Device& device, std::size_t part, const fs::path& work) {
    RunOptions run = options_;
    run.folder = work;
    run.on_progress = [this](double fraction) { on_progress(fraction); };
    const Scene scene = scene_of(part);
    if (is_there(work)) try {
            run.start = Start::resume;
            return run_scene(device, scene, run).end;
        } catch (const InputError& error) {
            options_.on_warning(
                fmt::format("part {} is computed again, because its unfinished results cannot be used: {}",
                            part_name(part), error.what()));
            fs::remove_all(work);
        }
    run.start = Start::fresh;
    return run_scene(device, scene, run).end;
}

void RunParts::compute(Device& device, std::size_t part) try {
    if (is_merged(options_.folder)) return;
    keep_manifest(device_file(parts_folder(options_.folder)), manifest_of(device, scene_));
    if (is_whole(part)) return;
    const fs::path work = take_work_folder(part);
    if (run_part(device, part, work) == RunEnd::interrupted) throw Interrupted();
    move_file(run_file(work), part_file(options_.folder, part));
    fs::remove_all(work);
    // Others may have merged in the meantime.
    if (is_there(run_file(options_.folder))) merge();
} catch (const std::exception&) {
    // Another process may have merged the parts and removed their folder.
    if (!is_merged(options_.folder)) throw;
    expect_scene_of(options_.folder, scene_);
}

/// Locks exclude others, but not on every network file system.
void RunParts::expect_own_merge() const {
    if (read_run_header({run_file(options_.folder)}).scene != scene_.text)
        throw InputError(options_.folder.string() +
                         ": holds the run.h5 of another run beside the parts of this one: move one of them "
                         "(run.h5 and plate.csv; parts/) elsewhere");
}

/// False if a part is damaged; it is then removed.
bool RunParts::merge_files() try {
    std::vector<fs::path> files;
    for (std::size_t part = 0; part < count_; ++part) {
        if (options_.stop_wanted()) throw Interrupted();
        files.push_back(part_file(options_.folder, part));
        expect_own(part);
    }
    merge_parts(files, run_file(options_.folder), options_.stop_wanted);
    return true;
} catch (const DamagedPart& damaged) {
    warn_of_damage(damaged.part, damaged.what());
    fs::remove(part_file(options_.folder, damaged.part));
    return false;
}

/// Can be repeated safely, by two processes at the same time, and after an interruption anywhere.
bool RunParts::merge() try {
    if (is_merged(options_.folder)) return true;
    if (is_there(run_file(options_.folder)))
        expect_own_merge();
    else if (!missing().empty() || !merge_files())
        return is_merged(options_.folder);
    write_csv(options_.folder, options_.stop_wanted);
    remove_parts(old_parts(options_.folder));
    fs::rename(parts_folder(options_.folder), old_parts(options_.folder));
    remove_parts(old_parts(options_.folder));
    // Another process that merges at the same time may still write a file that already exists.
    remove_temporaries(options_.folder);
    return true;
} catch (const std::exception&) {
    if (!is_merged(options_.folder)) throw;
    expect_scene_of(options_.folder, scene_);
    if (is_there(old_parts(options_.folder))) throw;  // they cannot be removed; the run is whole
    return true;
}

}  // namespace mcdem::ensemble
