#include "scene/read/scene_warnings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>

#include "core/container.h"
#include "scene/packing/generate_packing.h"
#include "scene/packing/neighbour_slots.h"
#include "scene/packing/packing_state.h"
#include "scene/packing/stated_box.h"

namespace mcdem::inline scene {
namespace {

/// Overlaps beyond this part of a diameter are those of a loaded packing. Weight and errors of measured
/// positions cause less: 0.028 in the measured packing of hydrogel grains at rest.
constexpr double loaded = 0.03;

/// What the contacts of a replica remember and the packing does not say.
std::vector<std::string> missing_memory(const Replica& replica, const Packing& packing) {
    const Effects& effects = replica.effects;
    std::vector<std::string> all;
    if (mindlin_share(replica) > 0 && packing.tangential.empty()) all.emplace_back("friction springs");
    if (effects.plasticity > 0) all.emplace_back("plasticity");
    if (effects.viscoelasticity > 0) all.emplace_back("viscoelasticity");
    if (effects.rolling_resistance > 0) all.emplace_back("rolling resistance");
    return all;
}

/// A packing file that was read, with the deepest overlap over the smaller diameter in the first of its
/// scenes.
struct ReadFile {
    FilePacking packing;
    double overlap = 0;
};

ReadFile read_file_of(const PackingFile& file, const Replica& replica) {
    ReadFile read{file.read()};
    const PlateFace plate = plate_face(replica, replica.plate.start);
    read.overlap = packing_state(read.packing, replica.box, plate).relative_overlap;
    return read;
}

/// A loaded packing whose contacts begin without a history; empty if there is nothing to say.
std::string lost_history(const Replica& replica, const ReadFile& read, const std::string& file) {
    const std::vector<std::string> memory = missing_memory(replica, read.packing);
    if (memory.empty() || !(read.overlap > loaded)) return "";
    return fmt::format(
        "{}: grains overlap by up to {:.2g} % of a diameter, but the history of their contacts is not in the "
        "file "
        "({}): it starts anew, and forces differ from those of the packing's own past",
        file, 100 * read.overlap, fmt::join(memory, ", "));
}

/// Columns of a CSV file that have no meaning; empty if there are none.
std::string not_read(const FilePacking& packing, const std::string& file) {
    if (packing.unread.empty()) return "";
    return fmt::format(
        "{}: {} {} not read: other columns than those listed in scenes/README.md, Packings, mean nothing",
        file, fmt::join(packing.unread, ", "), packing.unread.size() == 1 ? "is" : "are");
}

/// Species of a file for a scene that does not distinguish them; empty if there is nothing to say.
std::string not_distinguished(const Replica& replica, const FilePacking& packing, const std::string& file) {
    if (replica.species.size() > 1 || packing.species_names.size() < 2) return "";
    return fmt::format(
        "{}: its grains are of {} species ({}), but the scene does not distinguish them: all are of one "
        "material, unless it has as many [[species]]",
        file, packing.species_names.size(), fmt::join(packing.species_names, ", "));
}

/// Generated grains so unlike that the largest may have more neighbours than there can be slots; empty if
/// not.
std::string too_unlike(const Replica& replica, const GeneratedPacking& grains) {
    const double most = expected_neighbours(grains.diameter_mean, grains.diameter_max, replica.numerics);
    if (!(most > most_slots)) return "";
    return fmt::format(
        "packing: a grain of {:.3g} m among grains of {:.3g} m may have {:.0f} near neighbours, but "
        "at most {} are possible (numerics.slots): {}",
        grains.diameter_max, grains.diameter_mean, most, most_slots, widest_sizes);
}

/// A plate that never comes down to the grains; empty if it does.
std::string misses_packing(const Replica& replica, double top) {
    if (is_cell(replica.box) || replica.plate.end < top) return "";
    return fmt::format(
        "plate.end: the plate touches no grain: it stays above {:.6g} m, and the packing is {:.6g} m high",
        replica.plate.end, top);
}

double top_of(const Packing& packing) {
    double top = 0;
    for (std::size_t i = 0; i < packing.size(); ++i)
        top = std::max(top, packing.position[i].z() + packing.diameter[i] / 2);
    return top;
}

}  // namespace

std::vector<std::string> scene_warnings(const Scene& scene) {
    std::map<std::pair<std::string, std::optional<long>>, ReadFile> files;
    std::vector<std::string> warnings;
    const auto add = [&](const std::string& warning) {
        if (!warning.empty() && std::ranges::find(warnings, warning) == warnings.end())
            warnings.push_back(warning);
    };
    for (const Replica& replica : scene.replicas) {
        if (const auto* drawn = std::get_if<GeneratedPacking>(&replica.packing.source)) {
            add(too_unlike(replica, *drawn));
            add(misses_packing(replica, expected_height(*drawn, replica.box, mixture_of(replica))));
        }
        const auto* file = std::get_if<PackingFile>(&replica.packing.source);
        if (!file) continue;
        const auto [place, is_new] = files.try_emplace({file->path, file->step});
        if (is_new) place->second = read_file_of(*file, replica);
        const FilePacking& packing = place->second.packing;
        for (const std::string& warning : compare_box(packing, packing.box, replica.box).warnings)
            add(warning);
        add(lost_history(replica, place->second, file->path));
        add(not_read(packing, file->path));
        add(not_distinguished(replica, packing, file->path));
        add(misses_packing(replica, top_of(packing)));
    }
    return warnings;
}

}  // namespace mcdem::scene
