#include "ensemble/parts/manifest.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "cl/program.h"
#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/input_file.h"
#include "core/look.h"
#include "core/sha256.h"

namespace mcdem::inline ensemble {
namespace {

/// Common digest of all packing files of the scene, whose contents may change under the same name.
std::string digest_of_packing_files(const Scene& scene) {
    std::set<std::string> files;
    for (const Replica& replica : scene.replicas)
        if (const auto* file = std::get_if<PackingFile>(&replica.packing.source)) files.insert(file->path);
    Sha256 digest;
    for (const auto& file : files) digest.add(read_file(file)).add("\n");
    return digest.hex();
}

}  // namespace

Manifest manifest_of(const Scene& scene, const std::string& program) {
    return {{"program", program},
            {"kernels", Sha256().add(program_text()).hex()},
            {"scene with its overrides", Sha256().add(scene.text).hex()},
            {"packing files", digest_of_packing_files(scene)}};
}

Manifest manifest_of(const Device& device, const Scene& scene) {
    const KernelBuild build = kernel_build(device, scene.precision, scene.slots);
    return {{"device", fmt::format("{}, {} lanes", device.description(), build.lanes)}};
}

std::filesystem::path manifest_file(const std::filesystem::path& folder) { return folder / "manifest.json"; }
std::filesystem::path device_file(const std::filesystem::path& folder) { return folder / "device.json"; }

std::optional<Manifest> read_manifest(const std::filesystem::path& file) {
    if (!is_there(file)) return std::nullopt;
    const auto read = nlohmann::json::parse(read_file(file), nullptr, false);
    Manifest found;
    if (!read.is_object() || read.empty()) return std::nullopt;
    for (const auto& [name, value] : read.items()) {
        if (!value.is_string()) return std::nullopt;
        found[name] = value;
    }
    return found;
}

Manifest keep_manifest(const std::filesystem::path& file, const Manifest& wanted, const std::string& chosen) {
    const std::string text = nlohmann::json(wanted).dump(1) + "\n";
    if (create_file(file, text)) return wanted;
    const auto kept = read_manifest(file);
    if (!kept)
        throw InputError(file.string() + ": is damaged: restore it from a copy, or give another folder");
    std::vector<std::string> problems;
    for (const auto& [name, mine] : wanted) {
        const auto found = kept->find(name);
        const std::string theirs = found == kept->end() ? "" : found->second;
        if (theirs != mine && name != chosen)
            problems.push_back(
                fmt::format("{}: was begun with another {}: {}; got {}: give the same, or another folder",
                            file.parent_path().string(), name, theirs, mine));
    }
    if (!problems.empty()) throw InputError(problems);
    return *kept;
}

}  // namespace mcdem::ensemble
