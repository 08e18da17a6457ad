#include "scene/read/replicas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/container.h"
#include "scene/packing/generate_packing.h"
#include "scene/read/list_tables.h"
#include "scene/read/resolve_species.h"
#include "scene/read/toml_text.h"

namespace mcdem::inline scene {
namespace {

/// Words are used alone, numbers with their key, and with its table if two keys would look the same.
std::string label_part(const Key& key, const Settings& settings, const std::vector<Variation>& variations) {
    const std::string value = value_text(key, settings);
    if (std::holds_alternative<MemberOf<ContactModel>>(key.member) ||
        std::holds_alternative<MemberOf<FrictionLaw>>(key.member) ||
        std::holds_alternative<MemberOf<ContainerShape>>(key.member))
        return value;
    if (key.name == "packing.file") return std::filesystem::path(value).filename().string();
    const auto alike = std::ranges::count_if(variations, [&](const Variation& other) {
        return last_part(other.key->name) == last_part(key.name);
    });
    return fmt::format("{}={}", alike > 1 ? key.name : last_part(key.name), value);
}

Parameters parameters(const Settings& settings) {
    Parameters all;
    for (const Key& key : keys()) {
        const bool applies = (settings.packing_file.empty() || !is_generator_key(key.name)) &&
                             is_key_of(settings.replica.box.shape, key.name);
        all[std::string(key.name)] = applies ? value_of(key, settings) : Parameter();
    }
    if (!settings.replica.species.empty())
        for (const char* key : {"mean", "sd", "min", "max"})
            all[fmt::format("packing.diameter_{}", key)] = {};
    for (const ListTable& table : list_tables())
        for (std::size_t n = 0; n < table.size(settings.replica); ++n)
            for (const Key& key : table.keys(static_cast<int>(n)))
                all[std::string(key.name)] = value_of(key, settings);
    return all;
}

void set_container(Settings& settings) {
    Box& box = settings.replica.box;
    if (is_cylinder(box)) box.size_x = box.size_y = 2 * settings.cylinder_radius;
    if (!is_cell(box)) return;
    const bool generated = settings.packing_file.empty() && has_sizes(settings.replica);
    box.height = generated ? expected_height(settings.generated, box, mixture_of(settings.replica))
                 : std::isnan(settings.cell_height) ? box.size_x
                                                    : settings.cell_height;
    settings.replica.plate = {box.height, 0};
}

}  // namespace

double combination_count(const std::vector<Variation>& variations) {
    double count = 1;
    for (const Variation& variation : variations) count *= static_cast<double>(variation.values.size());
    return count;
}

std::vector<Combination> combinations(const Settings& base, const std::vector<Variation>& variations) {
    std::vector<Combination> all{{base, ""}};
    for (const Variation& variation : variations) {
        std::vector<Combination> next;
        for (const Combination& before : all)
            for (const toml::node* value : variation.values) {
                Combination one = before;
                assign(*variation.key, *value, one.settings);
                one.label +=
                    (one.label.empty() ? "" : ", ") + label_part(*variation.key, one.settings, variations);
                next.push_back(std::move(one));
            }
        all = std::move(next);
    }
    SizeTables tables;
    for (Combination& one : all) {
        resolve_species(one.settings, tables);
        set_container(one.settings);
    }
    return all;
}

/// Soft grains of some millimetres take the upper limits. Stiff or small ones come to rest in microseconds: a
/// maximum of a second would be millions of steps, which packings that creep would all make. In units of
/// their Rayleigh time all grains relax alike: packings of `scenes/` rest after 200 to 900 of them.
void set_times(Settings& settings, double smallest_diameter) {
    constexpr double relax = 1, settle = 0.5;  // [s]
    constexpr double relax_in_own_times = 2000, settle_in_own_times = 1000;
    const double own = rayleigh_time(settings.replica, smallest_diameter / 2);
    Protocol& protocol = settings.replica.protocol;
    if (std::isnan(protocol.relax_time)) protocol.relax_time = std::min(relax, relax_in_own_times * own);
    if (std::isnan(protocol.settle_time)) protocol.settle_time = std::min(settle, settle_in_own_times * own);
}

std::vector<Replica> make_replicas(const std::vector<Combination>& combinations) {
    std::vector<Replica> replicas;
    for (const Combination& combination : combinations) {
        const std::string label = combination.label.empty()
                                      ? std::string(name(combination.settings.replica.contact.model))
                                      : combination.label;
        for (int copy = 0; copy < combination.settings.copies; ++copy) {
            Settings settings = combination.settings;
            settings.replica.packing.seed += static_cast<std::uint64_t>(copy);
            Replica replica = settings.replica;
            replica.label = settings.copies > 1 ? fmt::format("{} #{}", label, copy + 1) : label;
            replica.parameters = parameters(settings);
            if (settings.packing_file.empty())
                replica.packing.source = settings.generated;
            else
                replica.packing.source = packing_file_of(settings);
            replicas.push_back(std::move(replica));
        }
    }
    return replicas;
}

}  // namespace mcdem::scene
