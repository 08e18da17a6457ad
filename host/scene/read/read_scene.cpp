#include "scene/read/read_scene.h"

#include <fmt/format.h>

#include "core/container.h"
#include "core/errors.h"
#include "core/input_file.h"
#include "core/look.h"
#include "scene/read/list_tables.h"
#include "scene/read/replicas.h"
#include "scene/read/scene_checks.h"
#include "scene/read/scene_document.h"
#include "scene/read/toml_text.h"

namespace mcdem::inline scene {
namespace {

/// Processes a document once and collects settings, variations and all problems.
class SceneReader {
public:
    SceneReader(std::string_view text, const std::string& source, const std::vector<std::string>& overrides,
                const PackingReader& packings)
        : document_(text, source, overrides, problems_) {
        settings_.packing_reader = packings;
        settings_.run.name = std::filesystem::path(source).stem().string();
    }

    Scene read() {
        for (const Entry& entry : document_.entries()) read_entry(entry);
        check_packing_source();
        check_container();
        check_size(1);
        if (problems_.empty() || combination_count(variations_) <= max_replicas) check_combinations();
        problems_.report();
        Scene scene = settings_.run;
        scene.text = document_.text();
        if (scene.slots == 0) scene.slots = slots_;
        scene.replicas = make_replicas(combinations_);
        return scene;
    }

private:
    void read_entry(const Entry& entry) {
        const Key* key = find_key(entry.key);
        if (!key) {
            refuse_unknown(entry);
        } else if (entry.varied) {
            read_variation(entry, *key);
        } else if (const auto problem = assign(*key, *entry.value, settings_)) {
            problems_.add(entry.place, fmt::format("{} {}", key->name, *problem));
            add_bad(*key);
        }
    }

    void add_bad(const Key& key) {
        bad_.insert(std::string(key.name));
        if (const Key* same = same_key(key.name)) bad_.insert(std::string(same->name));
    }

    void refuse_unknown(const Entry& entry) {
        const std::string full_name = entry.full_name(), shown_name = shortened(full_name);
        const auto element = list_element(full_name);
        if (const ListTable* table = find_list_table(full_name))
            problems_.add(entry.place,
                          fmt::format("{0} must be a list of 1 to {1} {2} ([[{0}]]), got {3}", table->name,
                                      table->most, table->elements, shown(*entry.value)));
        else if (const ListTable* of = find_list_table(full_name.substr(0, full_name.find('.')));
                 of && !element)
            problems_.add(
                entry.place,
                fmt::format("{0} must be below a header in double brackets, [[{1}]], one for each of its {2}",
                            shown_name, of->name, of->elements));
        else if (entry.value->is_table() && element && is_table(full_name))
            problems_.add(entry.place, fmt::format("{} must say {}, got nothing: {}", shown_name,
                                                   element->table->says, element->table->remedy));
        else if (is_table(full_name))
            problems_.add(entry.place,
                          fmt::format("{} must be a table, got {}", shown_name, shown(*entry.value)));
        else
            problems_.add(entry.place,
                          fmt::format("{} must be a {} of a scene, got an unknown one{}", shown_name,
                                      entry.value->is_table() ? "table" : "key", suggestion(entry.key)));
    }

    void read_variation(const Entry& entry, const Key& key) {
        const std::string name = fmt::format("batch.vary.\"{}\"", key.name);
        add_bad(key);  // until all its values are known to be valid
        if (key.scope == Scope::run) {
            problems_.add(entry.place,
                          name + " must be a key of which replicas have their own, got one of the whole run");
            return;
        }
        const toml::array* list = entry.value->as_array();
        if (!list || list->empty()) {
            problems_.add(entry.place, fmt::format("{} must be a list of values, got {}", name,
                                                   list ? "an empty one" : shown(*entry.value)));
            return;
        }
        Variation variation{&key, {}};
        bool good = true;
        std::set<std::string> texts;
        for (const toml::node& value : *list) {
            Settings trial;
            auto problem = assign(key, value, trial);
            if (!problem && !texts.insert(value_text(key, trial)).second)  // not an independent replica
                problem = fmt::format("must name each value once, got {} again", shown(value));
            if (problem) {
                problems_.add(document_.place_of(entry, value), fmt::format("{} {}", name, *problem));
                good = false;
            }
            variation.values.push_back(&value);
        }
        if (!good) return;
        bad_.erase(std::string(key.name));
        if (const Key* same = same_key(key.name)) bad_.erase(std::string(same->name));
        variations_.push_back(std::move(variation));
        check_said_once(entry, key);
    }

    void check_said_once(const Entry& entry, const Key& key) {
        for (const Entry& other : document_.entries())
            if (!other.varied && other.key == key.name)
                problems_.add(
                    entry.place,
                    fmt::format("batch.vary.\"{}\" must be the only place of {}, got a value too at {}",
                                key.name, key.name, other.place.text));
    }

    bool varies(std::string_view key) const {
        for (const Variation& variation : variations_)
            if (variation.key->name == key) return true;
        return false;
    }

    /// Keys that are set or varied.
    std::set<std::string> said() const {
        std::set<std::string> keys;
        for (const Entry& entry : document_.entries()) keys.insert(entry.key);
        return keys;
    }

    /// Place of the key; for a stage or species the first place of any of its keys.
    Place place_of(const std::string& key) const {
        const Place place = document_.place_of(key);
        const auto element = list_element(key);
        if (place.line > 0 || !element) return place;
        for (const Entry& entry : document_.entries())
            if (!entry.varied && list_element(entry.key) == element) return entry.place;
        return place;
    }

    /// A packing file and generated grains are mutually exclusive.
    void check_packing_source() {
        const bool from_file = !settings_.packing_file.empty() || varies("packing.file");
        for (const Entry& entry : document_.entries())
            if (from_file && is_generator_key(entry.key))
                problems_.add(entry.place, entry.key + " must be left out where packing.file is given");
        const bool may_be_cell = is_cell(settings_.replica.box) || varies("container.shape");
        if (const Entry* height = document_.find("container.height"); height && !from_file && may_be_cell)
            problems_.add(height->place,
                          "container.height must be left out where the packing is generated: it "
                          "follows from packing.count and packing.packing_fraction");
        if (!from_file && (settings_.packing_frame >= 0 || varies("packing.frame")))
            problems_.add(document_.place_of("packing.frame"),
                          "packing.frame must be left out where no packing.file is given");
        if (settings_.copies > 1 && varies("packing.seed"))
            problems_.add(
                document_.place_of("batch.replicas"),
                "batch.replicas must be 1 where packing.seed varies: it gives every copy its own seed");
    }

    /// Sizes are given only once, and belong to the selected shape.
    void check_container() {
        std::set<ContainerShape> shapes{settings_.replica.box.shape};
        for (const Variation& variation : variations_)
            if (variation.key->name == "container.shape")
                for (const toml::node* value : variation.values) {
                    Settings trial;
                    assign(*variation.key, *value, trial);
                    shapes.insert(trial.replica.box.shape);
                }
        for (const Key& key : keys()) {
            const Entry* entry = document_.find(key.name);
            if (!entry) continue;
            if (std::ranges::none_of(shapes, [&](auto shape) { return is_key_of(shape, key.name); }))
                problems_.add(entry->place, fmt::format("{} must be left out where container.shape = \"{}\"",
                                                        key.name, name(*shapes.begin())));
            const Key* same = same_key(key.name);
            if (same && key.name.starts_with("box.") && document_.find(same->name))
                problems_.add(entry->place,
                              fmt::format("{} must be left out where {} is given", key.name, same->name));
        }
    }

    /// The key's name as used in the scene.
    std::string given_name(const std::string& key) const {
        const Key* same = same_key(key);
        return std::string(same && !document_.find(key) && document_.find(same->name) ? same->name : key);
    }

    void check_size(double grains) {
        const double replicas = combination_count(variations_) * settings_.copies;
        const Place place = document_.place_of("batch.replicas");
        if (replicas > max_replicas)
            problems_.add(place,
                          fmt::format("batch.replicas must leave at most {:.9g} replicas in all, got {:.9g}",
                                      max_replicas, replicas));
        else if (replicas * grains > max_grains)
            problems_.add(place, fmt::format("batch.replicas must leave at most {:.9g} grains in all, got "
                                             "{:.9g} replicas of up to {:.9g}",
                                             max_grains, replicas, grains));
    }

    void check_combinations() {
        CheckedFiles files;
        std::size_t grains = 1;
        combinations_ = combinations(settings_, variations_);
        const std::set<std::string> said_keys = said();
        for (Combination& combination : combinations_) {
            Settings& settings = combination.settings;
            for (const CrossProblem& problem : cross_problems(settings, bad_)) {
                const std::string key = given_name(problem.key);
                problems_.add(document_.place_of(key), fmt::format("{} {}", key, problem.what));
            }
            for (const CrossProblem& problem : species_problems(settings, said_keys, bad_))
                problems_.add(place_of(problem.key), fmt::format("{} {}", problem.key, problem.what));
            for (const CrossProblem& problem : programme_problems(settings, said_keys, bad_))
                problems_.add(place_of(problem.key), fmt::format("{} {}", problem.key, problem.what));
            if (!bad_.contains("packing.file"))
                for (const std::string& problem : packing_file_problems(settings, files))
                    problems_.add(document_.place_of("packing.file"), problem);
            if (!settings.packing_file.empty() && settings.copies > 1 &&
                settings.replica.packing.position_jitter == 0)
                problems_.add(
                    document_.place_of("batch.replicas"),
                    "batch.replicas must be 1 where packing.file is given without packing.position_jitter: "
                    "all copies would be identical");
            if (problems_.empty()) slots_ = std::max(slots_, slots_needed(settings, files));
            const GrainsOfReplica known = grains_of(settings, files);
            set_times(settings, known.smallest);
            grains = std::max(grains, known.count);
            if (static_cast<double>(grains * combinations_.size()) > max_grains) break;
        }
        check_size(static_cast<double>(grains));
    }

    Problems problems_;
    SceneDocument document_;
    Settings settings_;
    std::set<std::string, std::less<>> bad_;  ///< keys with problems of their own
    std::vector<Variation> variations_;
    std::vector<Combination> combinations_;
    int slots_ = 16;  ///< enough for all replicas
};

}  // namespace

Scene parse_scene(std::string_view toml_text, std::string source_name,
                  const std::vector<std::string>& overrides, const PackingReader& packings) {
    return SceneReader(toml_text, source_name, overrides, packings).read();
}

Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                 const PackingReader& packings) {
    if (!is_file(file))
        throw InputError(fmt::format("{}: must be a scene, got {}", file.string(),
                                     is_there(file) ? "something that is not a file" : "no such file"));
    constexpr std::uintmax_t largest_file = 1 << 20;
    if (size_of_file(file) > largest_file)
        throw InputError(
            fmt::format("{}: a scene must be at most {} bytes long", file.string(), largest_file));
    return parse_scene(read_file(file), file.string(), overrides, packings);
}

}  // namespace mcdem::scene
