#include "scene/read/change_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/errors.h"
#include "scene/programme/programme_text.h"
#include "scene/read/keys.h"
#include "scene/read/list_tables.h"
#include "scene/read/scene_checks.h"
#include "scene/read/toml_text.h"

namespace mcdem::inline scene {
namespace {

/// Whether the key determines packings, containers or the number of replicas.
bool is_fixed(std::string_view name) {
    for (const std::string_view begin :
         {"name", "container.", "box.", "packing.", "batch.", "numerics.slots"})
        if (name.starts_with(begin)) return true;
    if (!name.starts_with("species.")) return false;
    const std::string_view last = last_part(name);
    return last == "name" || last == "fraction" || last == "sizes" || last.starts_with("diameter_");
}

/// The key if the replica has it and it can be changed, or null.
const Key* changeable_key(const std::string& name, const Replica& replica) {
    const auto element = list_element(name);
    if (element && element->number >= static_cast<int>(element->table->size(replica))) return nullptr;
    if (!replica.species.empty() && name.starts_with("grains.")) return nullptr;  // species have their own
    if (!is_key_of(replica.box.shape, name)) return nullptr;
    return is_fixed(name) ? nullptr : find_key(name);
}

Settings settings_of(const Scene& run, const Replica& replica) {
    Settings settings;
    settings.run = run;
    settings.replica = replica;
    settings.cylinder_radius = replica.box.size_x / 2;
    settings.cell_height = replica.box.height;
    if (const auto* file = std::get_if<PackingFile>(&replica.packing.source))
        settings.packing_file = file->path;
    else
        settings.generated = std::get<GeneratedPacking>(replica.packing.source);
    return settings;
}

}  // namespace

std::vector<std::pair<std::string, Parameter>> values_of_keys(const Scene& scene) {
    const Replica& replica = scene.replicas.front();
    Settings settings = settings_of(scene, replica);
    settings.cylinder_radius = Settings().cylinder_radius;  // the sizes of the box have them
    settings.cell_height = not_given;
    std::vector<std::pair<std::string, Parameter>> values;
    for (const Key& key : keys())
        if (key.scope == Scope::replica || key.name == "numerics.precision")
            values.emplace_back(key.name, value_of(key, settings));
    for (const auto& stage : programme_parameters(replica.programme)) values.emplace_back(stage);
    return values;
}

Scene variant_of(const Scene& scene, const std::map<std::string, std::string>& values) {
    Scene variant = scene;
    variant.replicas.resize(1);
    Replica& replica = variant.replicas.front();
    Settings settings = settings_of(variant, replica);
    for (const auto& [name, text] : values) {
        const Key* known = find_key(name);
        const auto value = parse_value(text);
        if (!known || !value) throw InputError(name + ": is no key, or has no value of TOML: " + text);
        if (known->scope != Scope::replica)
            throw InputError(name + ": is a key of the run, not of a replica");
        Key key = *known;
        if (std::holds_alternative<MemberOf<double>>(key.member)) key.range = {-HUGE_VAL, HUGE_VAL};
        if (std::holds_alternative<MemberOf<int>>(key.member)) key.range = {0, 1e9};
        if (const auto problem = assign(key, *value->get("value"), settings))
            throw InputError(fmt::format("{} {}", name, *problem));
    }
    replica = std::move(settings.replica);
    return variant;
}

Scene with_programme(const Scene& scene, const Parameters& parameters) {
    Scene changed = scene;
    for (Replica& replica : changed.replicas) {
        std::erase_if(replica.parameters,
                      [](const auto& one) { return one.first.starts_with("programme."); });
        replica.programme = programme_of(parameters);
        replica.parameters.merge(programme_parameters(replica.programme));
    }
    return changed;
}

Scene with_changes(const Scene& scene, const std::map<std::string, std::string>& values) {
    std::vector<std::string> problems;
    const auto report = [&](std::string problem) {
        if (std::ranges::find(problems, problem) == problems.end()) problems.push_back(std::move(problem));
    };
    Scene changed = scene;
    Scene run = scene;
    run.replicas.clear();
    for (Replica& replica : changed.replicas) {
        Settings settings = settings_of(run, replica);
        for (const auto& [name, text] : values) {
            const Key* key = changeable_key(name, replica);
            const auto value = parse_value(text);
            if (!key || !value) {
                report(fmt::format("{}: must be a key {}, got {}", name,
                                   key ? "with a value of TOML" : "that can change on the same packings",
                                   key ? text : "another one"));
            } else if (const auto problem = assign(*key, *value->get("value"), settings)) {
                report(fmt::format("{} {}", name, *problem));
            } else {
                settings.replica.parameters[name] = value_of(*key, settings);
            }
        }
        for (const CrossProblem& problem : cross_problems(settings, {}))
            report(fmt::format("{} {}", problem.key, problem.what));
        replica = settings.replica;
        changed.precision = settings.run.precision;
        changed.output = settings.run.output;
        changed.slots = settings.run.slots;
    }
    if (!problems.empty()) throw InputError(problems);
    return changed;
}

}  // namespace mcdem::scene
