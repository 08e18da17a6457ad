#include "experiment/settings.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "core/container.h"
#include "core/input_file.h"
#include "scene/packing/packing_fields.h"
#include "scene/programme/programme_text.h"
#include "scene/read/keys.h"
#include "scene/read/list_tables.h"
#include "scene/read/scene_checks.h"
#include "scene/read/toml_text.h"

namespace mcdem::inline experiment {
namespace {

/// A number of experiment.toml that scenes do not have, or with another range: lengths are those of a
/// laboratory, because longer ones are in millimetres.
Key own_key(std::string_view name, const Range& range, std::string_view unit) {
    return {name, MemberOf<double>(nullptr), unit, range, Scope::run, {}};
}

constexpr std::size_t max_key_length = 1000;  // in --set
constexpr double largest_box = 20;            // [m]; a larger one was given in millimetres

class Reader {
public:
    Reader(std::string file, FileProblems& problems) : file_(std::move(file)), problems_(problems) {}

    void read(const toml::table& root, Experiment& experiment) {
        const auto name = root.get("name");
        if (name && !name->is_string()) problem(*name, "name must be a text");
        if (name) experiment.name = name->value_or(std::string());
        read_container(root, experiment.recording.box);
        experiment.recording.plate_start =
            number(root, own_key("plate.start", {0, 100, Range::Low::excluded}, "m")).value_or(std::nan(""));
        experiment.plate_speed = number(root, *find_key("plate.speed"));
        experiment.plate_pause = number(root, own_key("plate.pause", {0, 1e6}, "s")).value_or(0);
        experiment.plate_hold = number(root, own_key("plate.hold", {0, 1e6}, "s")).value_or(0);
        for (const std::string& key : material_keys()) {
            if (const auto value = number(root, *find_key(key))) experiment.materials[key] = *value;
            read_sigma(root, *find_key(key), experiment);
        }
        Measurement& errors = experiment.measurement;
        const auto error = [&](std::string_view name, double highest, std::string_view unit) {
            return number(root, own_key(name, {0, highest}, unit)).value_or(0);
        };
        errors.position_error = error("measurement.position_error", 1, "m");
        errors.diameter_error = error("measurement.diameter_error", 1, "m");
        errors.force_error = error("measurement.force_error", 10, "");
        errors.force_threshold = error("measurement.force_threshold", 1e9, "N");
        read_programme(root, experiment);
        report_unknown(root, "");
    }

private:
    void problem(const toml::node& node, const std::string& what) {
        const auto line = node.source().begin.line;  // 0: from an override
        problems_.add(line > 0 ? fmt::format("{}:{}", file_, line) : "--set", what);
    }

    void known(std::string_view key) { known_.insert(std::string(key)); }

    std::optional<double> number(const toml::table& root, const Key& key) {
        known(key.name);
        const auto node = root.at_path(key.name);
        if (!node) return std::nullopt;
        const auto value = node.is_number() ? node.value<double>() : std::nullopt;
        if (value && key.range.contains(*value)) return value;
        problem(*node.node(),
                fmt::format("{} must be {}, got {}", key.name, description(key), shown(*node.node())));
        return std::nullopt;
    }

    void read_container(const toml::table& root, Box& box) {
        known("container.shape");
        if (const auto shape = root.at_path("container.shape")) {
            const auto known_shape = parse<ContainerShape>(shape.value_or(std::string()));
            if (!known_shape || *known_shape == ContainerShape::cell)
                return problem(
                    *shape.node(),
                    "container.shape must be \"box\", \"cylinder\" or \"periodic\": an experiment is a "
                    "compression by a plate");
            box.shape = *known_shape;
        }
        if (is_cylinder(box))
            read_radius(root, box);
        else
            read_size(root, box);
    }

    void read_radius(const toml::table& root, Box& box) {
        const auto radius =
            number(root, own_key("container.radius", {0, largest_box / 2, Range::Low::excluded}, "m"));
        if (radius) box.size_x = box.size_y = 2 * *radius;
        if (!radius && !root.at_path("container.radius"))
            problems_.add(file_,
                          "container.radius must be the inner radius of the cylinder [m], such as 0.06");
    }

    void read_size(const toml::table& root, Box& box) {
        known("box.size");
        const auto node = root.at_path("box.size");
        const auto* size = node.as_array();
        const auto width = size && size->size() == 2 ? size->get(0)->value<double>() : std::nullopt;
        const auto depth = width ? size->get(1)->value<double>() : std::nullopt;
        if (!depth) {
            constexpr auto what =
                "box.size must be the inner width and depth of the box, two numbers [m], such as [0.165, "
                "0.166]";
            if (node)
                problem(*node.node(), what);
            else
                problems_.add(file_, what);
            return;
        }
        box.size_x = *width;
        box.size_y = *depth;
        for (double length : {box.size_x, box.size_y})
            if (!(length > 0 && length <= largest_box))
                problem(*node.node(),
                        fmt::format("box.size must be > 0 and <= {} [m], got {}: divide by 1000 if it is in "
                                    "millimetres",
                                    largest_box, length));
    }

    /// `[uncertainty]` contains full names of keys ("walls.friction"), or for grains the last word
    /// ("friction").
    void read_sigma(const toml::table& root, const Key& key, Experiment& experiment) {
        std::vector<std::string> names{fmt::format("uncertainty.{}", key.name)};
        if (key.name.starts_with("grains."))
            names.push_back(fmt::format("uncertainty.{}", last_part(key.name)));
        for (const std::string& name : names)
            if (const auto sigma = number(root, own_key(name, {0, 1e15}, key.unit)))
                experiment.uncertainty[std::string(key.name)] = *sigma;
    }

    /// Reads the stages as in a scene, into the recording's parameters as for a simulation.
    void read_programme(const toml::table& root, Experiment& experiment) {
        known("programme");
        const toml::node* node = root.get("programme");
        if (!node) return;
        const toml::array* list = node->as_array();
        if (!list || list->empty() || list->size() > max_stages || !list->is_homogeneous<toml::table>())
            return problem(
                *node, fmt::format("programme must be a list of 1 to {} stages ([[programme]])", max_stages));
        const long before = problems_.count();
        Settings settings;
        std::map<std::string, const toml::node*> nodes;
        for (std::size_t n = 0; n < list->size(); ++n)
            read_stage(*list->get_as<toml::table>(n), static_cast<int>(n), settings, nodes);
        Recording& recording = experiment.recording;
        if (std::isnan(recording.plate_start))
            problem(*node, "[[programme]] requires plate.start: its strains are relative to that height");
        if (problems_.count() > before) return;
        settings.packing_file = experiment.name;  // the grains exist, so nothing is generated
        settings.replica.box = recording.box;
        settings.replica.plate = {recording.plate_start, 0};
        std::set<std::string> said;
        for (const auto& [key, value] : nodes) said.insert(key);
        for (const CrossProblem& found : programme_problems(settings, said, {}))
            problem(nodes.contains(found.key) ? *nodes[found.key] : *node,
                    fmt::format("{} {}", found.key, found.what));
        if (problems_.count() == before)
            recording.parameters.merge(programme_parameters(settings.replica.programme));
    }

    void read_stage(const toml::table& table, int number, Settings& settings,
                    std::map<std::string, const toml::node*>& nodes) {
        element(settings.replica.programme, static_cast<std::size_t>(number));
        for (const auto& [field, value] : table) {
            const std::string name = fmt::format("programme.{}.{}", number + 1, field.str());
            const Key* key = find_key(name);
            nodes[name] = &value;
            if (!key)
                problem(value, fmt::format("{} must be a key of a stage, got an unknown one{}",
                                           shortened(name), suggestion(name)));
            else if (const auto wrong = assign(*key, value, settings))
                problem(value, fmt::format("{} {}", name, *wrong));
        }
    }

    void report_unknown(const toml::table& table, const std::string& prefix) {
        for (const auto& [key, node] : table) {
            const std::string name = prefix + std::string(key.str());
            const auto first = known_.lower_bound(name + ".");
            const bool is_group = first != known_.end() && first->starts_with(name + ".");
            if (is_group && node.is_table())
                report_unknown(*node.as_table(), name + ".");
            else if (name != "name" && !known_.count(name))
                problem(node,
                        fmt::format(
                            "{} is not a key of an experiment: remove it, or see its README for the names",
                            name));
        }
    }

    std::string file_;
    FileProblems& problems_;
    std::set<std::string> known_;
};

}  // namespace

const std::vector<std::string>& material_keys() {
    static const std::vector<std::string> keys{
        "grains.youngs_modulus", "grains.poisson_ratio", "grains.excess_density", "grains.friction",
        "grains.restitution",    "walls.youngs_modulus", "walls.friction"};
    return keys;
}

namespace {

/// Puts "a.b=value" into the table; a value that is not TOML is a string.
void override_key(toml::table& root, const std::string& word, FileProblems& problems) {
    const auto equals = word.find('=');
    std::string_view path = std::string_view(word).substr(0, std::min(equals, word.size()));
    if (equals == word.npos || path.empty() || path.front() == '.' || path.back() == '.' ||
        path.find("..") != path.npos || path.size() > max_key_length)
        return problems.add("--set", fmt::format("must be KEY=VALUE such as box.size=[0.165,0.166], got {}",
                                                 quoted(std::string_view(word))));
    const std::string text = word.substr(equals + 1);
    const toml::table value = parse_value(text).value_or(toml::table{{"value", text}});
    toml::table* table = &root;
    for (auto dot = path.find('.'); dot != path.npos; dot = path.find('.')) {
        const auto part = path.substr(0, dot);
        if (!table->contains(part)) table->insert(part, toml::table());
        table = table->get(part)->as_table();
        if (!table) return problems.add("--set", fmt::format("{} must be a table, got a value before", part));
        path.remove_prefix(dot + 1);
    }
    // By visit, so that the copy has no line number of the overriding text.
    value.get("value")->visit([&](const auto& concrete) { table->insert_or_assign(path, concrete); });
}

}  // namespace

void parse_settings(std::string_view text, const std::string& file, const std::vector<std::string>& overrides,
                    Experiment& experiment, FileProblems& problems) {
    try {
        toml::table root = parse_toml(text, file);
        for (const std::string& word : overrides) override_key(root, word, problems);
        Reader(file, problems).read(root, experiment);
    } catch (const toml::parse_error& error) {
        problems.add(fmt::format("{}:{}", file, error.source().begin.line), std::string(error.description()));
    }
    for (const auto& [key, value] : experiment.materials)
        experiment.recording.parameters[key] = fmt::format("{}", value);
}

void read_settings(const std::filesystem::path& file, Experiment& experiment, FileProblems& problems) {
    experiment.name = file.parent_path().stem().string();
    parse_settings(read_file(file), file.string(), {}, experiment, problems);
}

std::string settings_text(const Experiment& experiment) {
    const Recording& recording = experiment.recording;
    const Measurement& errors = experiment.measurement;
    toml::table grains, walls, sigma_grains, sigma_walls;
    const auto insert = [](toml::table& of_grains, toml::table& of_walls,
                           const std::map<std::string, double>& values) {
        for (const auto& [key, value] : values) {
            const auto dot = key.find('.');
            (key.starts_with("walls.") ? of_walls : of_grains).insert(key.substr(dot + 1), value);
        }
    };
    insert(grains, walls, experiment.materials);
    insert(sigma_grains, sigma_walls, experiment.uncertainty);
    toml::table plate{{"start", recording.plate_start}};
    if (experiment.plate_speed) plate.insert("speed", *experiment.plate_speed);
    if (experiment.plate_pause > 0) plate.insert("pause", experiment.plate_pause);
    if (experiment.plate_hold > 0) plate.insert("hold", experiment.plate_hold);
    toml::table root{{"name", experiment.name},
                     {"plate", plate},
                     {"grains", grains},
                     {"walls", walls},
                     {"uncertainty", toml::table{{"grains", sigma_grains}, {"walls", sigma_walls}}},
                     {"measurement", toml::table{{"position_error", errors.position_error},
                                                 {"diameter_error", errors.diameter_error},
                                                 {"force_error", errors.force_error},
                                                 {"force_threshold", errors.force_threshold}}}};
    const Box& box = recording.box;
    toml::table container{{"shape", std::string(name(box.shape))}};
    if (is_cylinder(box))
        container.insert("radius", cylinder_radius(box));
    else
        root.insert("box", toml::table{{"size", toml::array{box.size_x, box.size_y}}});
    if (box.shape != ContainerShape::box) root.insert("container", container);
    if (const auto programme = programme_of(recording.parameters); !programme.empty())
        root.insert("programme", programme_tables(programme));
    std::stringstream text;
    text << root << '\n';
    return text.str();
}

}  // namespace mcdem::experiment
