#include "ensemble/agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "cl/program.h"
#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/input_file.h"
#include "core/sha256.h"

namespace mcdem {
namespace {

using nlohmann::json;

/// One digest of all packing files of the scene: their names are in the scene, what they hold may change.
std::string digest_of_packing_files(const Scene& scene) {
    std::set<std::string> files;
    for (const Replica& replica : scene.replicas)
        if (const auto* file = std::get_if<PackingFile>(&replica.packing.source)) files.insert(file->path);
    Sha256 digest;
    for (const auto& file : files) {
        digest.add(read_file(file)).add("\n");
    }
    return digest.hex();
}

bool is_agreement(const json& read) {
    const auto are_texts = [&](const char* name) {
        return read.contains(name) && read.at(name).is_object() &&
               std::ranges::all_of(read.at(name), [](const json& value) { return value.is_string(); });
    };
    return read.is_object() && are_texts("common") && are_texts("chosen");
}

json parsed(const std::filesystem::path& file) { return json::parse(read_file(file), nullptr, false); }

json read_agreement(const std::filesystem::path& file) {
    json read = parsed(file);
    if (!is_agreement(read))
        throw InputError(
            fmt::format("{}: is missing or damaged: restore it from a copy, or give another folder; what is "
                        "finished in {} can still be read",
                        file.string(), file.parent_path().string()));
    return read;
}

}  // namespace

Common common_of(const Device& device, const Scene& scene, const std::string& program) {
    const KernelBuild build = kernel_build(device, scene.precision, scene.slots);
    return {{"program", program},
            {"kernels", Sha256().add(program_text()).hex()},
            {"device", fmt::format("{}, {} lanes", device.description(), build.lanes)},
            {"scene with its overrides", Sha256().add(scene.text).hex()},
            {"packing files", digest_of_packing_files(scene)}};
}

Common agree(const std::filesystem::path& file, const Common& common, const Common& chosen) {
    if (create_file(file, json{{"common", common}, {"chosen", chosen}}.dump(1) + "\n")) return chosen;
    const json first = read_agreement(file);
    const Common before = first.at("common");
    std::vector<std::string> problems;
    for (const auto& [what, mine] : common) {
        const auto found = before.find(what);
        const std::string theirs = found == before.end() ? "" : found->second;
        if (theirs != mine)
            problems.push_back(fmt::format(
                "{}: the work there was begun with another {}: {}; got {}: give the same, or another folder",
                file.parent_path().string(), what, theirs, mine));
    }
    if (!problems.empty()) throw InputError(problems);
    return first.at("chosen");
}

bool is_damaged_agreement(const std::filesystem::path& file) {
    return std::filesystem::exists(file) && !is_agreement(parsed(file));
}

Common read_chosen(const std::filesystem::path& file) { return read_agreement(file).at("chosen"); }

}  // namespace mcdem
