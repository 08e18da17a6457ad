#include "ensemble/run_state.h"

#include <fmt/format.h>

#include <span>

#include "cl/program.h"
#include "core/errors.h"
#include "core/output_file.h"
#include "core/parameters.h"
#include "core/sha256.h"
#include "io/result_file.h"
#include "io/run_packing.h"
#include "scene/read/read_scene.h"

namespace mcdem::inline ensemble {
namespace {

const std::string program_field = "program";
const std::string kernels_field = "kernels";
const std::string packings_field = "packings";

std::vector<std::byte> bytes_of(const std::string& text) {
    const auto* begin = reinterpret_cast<const std::byte*>(text.data());
    return {begin, begin + text.size()};
}

std::string text_of(const Checkpoint& checkpoint, const std::string& field) {
    const auto found = checkpoint.fields.find(field);
    if (found == checkpoint.fields.end()) return "";
    return {reinterpret_cast<const char*>(found->second.data()), found->second.size()};
}

std::string digest_of(const std::vector<Packing>& packings) {
    Sha256 digest;
    for (const Packing& packing : packings) {
        const auto size = static_cast<double>(packing.size());
        digest.add(std::span(&size, 1));
        for (const auto* vectors : {&packing.position, &packing.velocity, &packing.angular_velocity})
            for (const Vec3& vector : *vectors) digest.add(std::span(vector.data(), 3));
        digest.add(packing.diameter);
        digest.add(std::vector<double>(packing.species.begin(), packing.species.end()));
    }
    return digest.hex();
}

/// Keys with different values in two scenes, for the first replica that differs: "contact.gamma is 1.2, was
/// 1". Empty if no key differs.
std::string changed_keys(const std::string& now, const std::string& then) {
    std::string text;
    try {
        const Scene new_scene = parse_scene(now, "scene", {}, read_packing_or_run),
                    old_scene = parse_scene(then, "scene", {}, read_packing_or_run);
        const std::size_t replicas = std::min(new_scene.replicas.size(), old_scene.replicas.size());
        for (std::size_t r = 0; r < replicas && text.empty(); ++r) {
            const auto& is = new_scene.replicas[r].parameters;
            const auto& was = old_scene.replicas[r].parameters;
            for (const auto& key : keys_that_vary({is, was}))
                text += fmt::format("{}{} is {}, was {}", text.empty() ? "" : "; ", key,
                                    parameter_text(find_parameter(is, key)),
                                    parameter_text(find_parameter(was, key)));
        }
    } catch (const InputError&) {  // a scene of another version
    }
    return text;
}

/// The first different line of two scenes.
std::string first_difference(const std::string& now, const std::string& then) {
    const auto line_of = [](const std::string& text, std::size_t begin) {
        return begin < text.size() ? text.substr(begin, text.find('\n', begin) - begin) : "nothing";
    };
    std::size_t begin = 0;
    for (std::size_t i = 0; i < std::min(now.size(), then.size()) && now[i] == then[i]; ++i)
        if (now[i] == '\n') begin = i + 1;
    return fmt::format("it now says `{}`, then `{}`", line_of(now, begin), line_of(then, begin));
}

void expect_same_scene(const std::string& now, const std::string& then, const std::string& folder) {
    if (now == then) return;
    const std::string changes = changed_keys(now, then);
    throw InputError(
        fmt::format("{}: must be resumed with the scene it was begun with, overrides "
                    "included; {}: give that one, or another folder",
                    folder, changes.empty() ? first_difference(now, then) : changes));
}

}  // namespace

RunIdentity identity_of(const Device& device, const Scene& scene, const std::string& program,
                        const std::vector<Packing>& packings) {
    const auto build = kernel_build(device, scene.precision, scene.slots);
    return {scene.text, fmt::format("{}, {} lanes", device.description(), build.lanes), program,
            Sha256().add(program_text()).hex(), digest_of(packings)};
}

void expect_room_for_run(const std::filesystem::path& folder) {
    expect_no_experiment(folder);
    expect_no_answers(folder);
    expect_replaceable_table(folder / "plate.csv");
}

void expect_scene_of(const std::filesystem::path& folder, const Scene& scene) {
    expect_same_scene(scene.text, read_run_header({run_file(folder)}).scene, folder.string());
}

Checkpoint make_checkpoint(const RunIdentity& identity, int segments,
                           std::map<std::string, std::vector<std::byte>> fields) {
    Checkpoint checkpoint;
    checkpoint.scene_text = identity.scene_text;
    checkpoint.device = identity.device;
    checkpoint.segments = segments;
    checkpoint.fields = std::move(fields);
    checkpoint.fields[program_field] = bytes_of(identity.program);
    checkpoint.fields[kernels_field] = bytes_of(identity.kernels);
    checkpoint.fields[packings_field] = bytes_of(identity.packings);
    return checkpoint;
}

std::optional<Checkpoint> find_checkpoint(const ResultFolder& folder, const RunIdentity& identity,
                                          const std::function<void(const std::string&)>& on_warning) {
    const std::string where = folder.path().string();
    const auto checkpoint = read_checkpoint(folder.path());
    if (!checkpoint) {
        // Stopped before its first checkpoint. Segments, if any, still identify the run.
        if (folder.segments() > 0)
            expect_same_scene(identity.scene_text, read_run_header(segment_files(folder.path())).scene,
                              where);
        return std::nullopt;
    }
    expect_same_scene(identity.scene_text, checkpoint->scene_text, where);
    if (checkpoint->device != identity.device)
        throw InputError(
            fmt::format("{}: must be resumed on the device it was begun on, {}; got {}: choose it "
                        "with --device, or start again in another folder",
                        where, checkpoint->device, identity.device));
    const auto program = text_of(*checkpoint, program_field);
    if (text_of(*checkpoint, kernels_field) != identity.kernels)
        throw InputError(
            fmt::format("{}: the checkpoint was written with other kernels, those of program {}; this is {}: "
                        "resume with the version it was begun with, or start again in another folder",
                        where, program, identity.program));
    if (text_of(*checkpoint, packings_field) != identity.packings)
        throw InputError(where +
                         ": must be resumed with the packing it was begun with: the packing file "
                         "has changed since, or this program draws other packings");
    if (checkpoint->segments > folder.segments())
        throw InputError(
            fmt::format("{}: must hold the {} segments that its checkpoint names, has {}: the "
                        "run cannot be resumed; start it again in another folder",
                        where, checkpoint->segments, folder.segments()));
    if (program != identity.program)
        on_warning(
            fmt::format("{}: was begun by {}, is continued by {}: results may differ from those of an "
                        "uninterrupted run",
                        where, program, identity.program));
    return checkpoint;
}

}  // namespace mcdem::ensemble
