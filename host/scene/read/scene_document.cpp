#include "scene/read/scene_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>

#include "core/errors.h"
#include "scene/read/list_tables.h"
#include "scene/read/toml_text.h"

namespace mcdem::inline scene {
namespace {

constexpr std::size_t largest_text = 1 << 20;

/// Whether this is [[programme]] or another table with several elements.
bool is_list_table(std::string_view name, const toml::node& node) {
    const ListTable* table = find_list_table(name);
    const std::size_t elements = node.as_array()->size();
    return table && elements >= 1 && elements <= static_cast<std::size_t>(table->most);
}

/// Keys of one stage of which at most one of each group may be set.
bool exclude_each_other(std::string_view a, std::string_view b) {
    if (stage_of(a) < 0 || stage_of(a) != stage_of(b)) return false;
    const auto group = [](std::string_view key) {
        key = key.substr(key.rfind('.') + 1);
        return key == "position" || key == "strain" || key == "force" ? 1
               : key == "scans" || key == "scan_at"                   ? 2
                                                                      : 0;
    };
    return group(a) != 0 && group(a) == group(b);
}

std::string bare(std::string key) {
    std::erase(key, '"');
    return key;
}

/// The value of an override as TOML; a bare word is a string. Nothing if it is neither.
std::optional<toml::table> parse_override(const std::string& value) {
    const bool one_line = std::ranges::none_of(value, [](unsigned char c) { return c < 32 || c == 127; });
    if (!one_line) return std::nullopt;
    if (auto parsed = parse_value(value)) return parsed;
    if (value.empty() || value.find_first_of("\"'[]{}=#,") != value.npos) return std::nullopt;
    return toml::table{{"value", value}};
}

}  // namespace

SceneDocument::SceneDocument(std::string_view text, std::string source,
                             const std::vector<std::string>& overrides, Problems& problems)
    : source_(std::move(source)), text_(text) {
    parse(text);
    flatten(tables_.front(), "", entries_);
    for (const std::string& one : overrides) apply(one, problems);
    sort_entries(problems);
    resolve_files();
}

void SceneDocument::parse(std::string_view text) {
    if (text.size() > largest_text)
        throw InputError(fmt::format("{}: a scene must be at most {} bytes long, got {}", source_,
                                     largest_text, text.size()));
    try {
        tables_.push_back(parse_toml(text, source_));
    } catch (const toml::parse_error& error) {
        const auto& at = error.source().begin;
        throw InputError(fmt::format("{}:{}:{}: must be TOML, got: {}", source_, at.line, at.column,
                                     shortened(std::string(error.description()), 200)));
    }
}

void SceneDocument::flatten(toml::table& table, const std::string& prefix, std::vector<Entry>& into) const {
    for (auto&& [key, node] : table) {
        const std::string name = prefix + std::string(key.str());
        if (node.is_table() && is_table(name))
            flatten(*node.as_table(), name + ".", into);
        else if (node.is_array() && is_list_table(name, node))
            flatten(*node.as_array(), name, into);
        else
            into.push_back(entry_of(name, node));
    }
}

/// `programme.1.force` belongs to the first stage. An element without keys is an entry too, so that it is
/// refused.
void SceneDocument::flatten(toml::array& elements, const std::string& table, std::vector<Entry>& into) const {
    int number = 0;
    for (toml::node& element : elements) {
        const std::string name = fmt::format("{}.{}", table, ++number);
        if (element.is_table() && !element.as_table()->empty())
            flatten(*element.as_table(), name + ".", into);
        else
            into.push_back(entry_of(name, element));
    }
}

Entry SceneDocument::entry_of(std::string key, toml::node& node) const {
    const auto& at = node.source().begin;
    const bool varied = key.starts_with(vary_prefix);
    if (varied) key.erase(0, vary_prefix.size());
    return {std::move(key),
            varied,
            &node,
            {fmt::format("{}:{}", source_, at.line), int(at.line), int(at.column)}};
}

void SceneDocument::sort_entries(Problems& problems) {
    std::ranges::stable_sort(
        entries_, {}, [](const Entry& entry) { return std::pair(entry.place.line, entry.place.column); });
    std::map<std::string, const Entry*> first;
    for (const Entry& entry : entries_) {
        const auto [earlier, is_new] = first.emplace(entry.full_name(), &entry);
        if (is_new) continue;
        problems.add(entry.place, fmt::format("{} must be given once, got it again after {}",
                                              shortened(entry.full_name()), earlier->second->place.text));
    }
}

void SceneDocument::apply(const std::string& override_text, Problems& problems) {
    changed_ = true;
    const auto equals = override_text.find('=');
    if (equals == override_text.npos || equals == 0) {
        problems.add(Place::override_of(shortened(override_text)), "an override must be key=value");
        return;
    }
    std::string key = bare(override_text.substr(0, equals));
    std::erase(key, ' ');
    const Place place = Place::override_of(shortened(key));
    auto parsed = parse_override(override_text.substr(equals + 1));
    if (!parsed) {
        problems.add(place, fmt::format("the value must be TOML or one word, got {}",
                                        shortened(override_text.substr(equals + 1))));
        return;
    }
    tables_.push_back(std::move(*parsed));
    std::vector<Entry> given;
    toml::node& value = *tables_.back().get("value");
    if (value.is_table() && is_table(key))
        flatten(*value.as_table(), key + ".", given);
    else if (value.is_array() && is_list_table(key, value))
        flatten(*value.as_array(), key, given);
    else
        given.push_back(entry_of(key, value));
    if (find_list_table(key))
        std::erase_if(entries_,
                      [&](const Entry& entry) { return !entry.varied && entry.key.starts_with(key + "."); });
    for (Entry& entry : given) {
        entry.place = place;
        put(entry);
    }
}

/// An override removes what it contradicts: the same key, its variation or the value that it varies, its
/// other name, and a packing file or generated grains.
void SceneDocument::put(const Entry& entry) {
    const std::string& key = entry.key;
    const auto contradicted = [&](const Entry& other) {
        if (other.key == key) return true;
        if (const Key* same = same_key(key); same && other.key == same->name) return true;
        if (other.place.line == entry.place.line)
            return false;  // overrides that contradict each other are an error
        return exclude_each_other(key, other.key) || (key == "packing.file" && is_generator_key(other.key)) ||
               (is_generator_key(key) && other.key == "packing.file");
    };
    std::erase_if(entries_, contradicted);
    entries_.push_back(entry);
}

void SceneDocument::resolve_files() {
    const auto resolve = [&](toml::node& node, const Place& place) {
        auto* path = node.as_string();
        if (!path || path->get().empty()) return;
        std::filesystem::path full(path->get());
        if (place.line != INT_MAX) full = std::filesystem::path(source_).parent_path() / full;
        *path = std::filesystem::absolute(full).lexically_normal().string();
        changed_ = true;
    };
    const auto is_path = [](std::string_view key) {
        return key == "packing.file" || (list_element(key) && key.ends_with(".diameter_file"));
    };
    for (Entry& entry : entries_) {
        if (!is_path(entry.key)) continue;
        if (!entry.varied)
            resolve(*entry.value, entry.place);
        else if (entry.value->is_array())
            for (auto& element : *entry.value->as_array()) resolve(element, entry.place);
    }
}

const Entry* SceneDocument::find(std::string_view key) const {
    const auto found = std::ranges::find(entries_, key, &Entry::key);
    return found == entries_.end() ? nullptr : &*found;
}

Place SceneDocument::place_of(std::string_view key) const {
    const Entry* entry = find(key);
    return entry ? entry->place : Place{source_, 0, 0};
}

Place SceneDocument::place_of(const Entry& entry, const toml::node& element) const {
    if (entry.place.line == INT_MAX) return entry.place;
    const auto& at = element.source().begin;
    return {fmt::format("{}:{}", source_, at.line), int(at.line), int(at.column)};
}

std::string SceneDocument::text() const {
    if (!changed_) return text_;
    toml::table whole;
    const auto inner = [](toml::table& table, std::string_view name) -> toml::table& {
        return *table.insert(name, toml::table{}).first->second.as_table();
    };
    for (const Entry& entry : entries_) {
        toml::table* table = &whole;
        std::string key = entry.key;
        if (entry.varied) {
            table = &inner(inner(whole, "batch"), "vary");
        } else if (const auto element = list_element(key)) {
            auto& list = *whole.insert(element->table->name, toml::array{}).first->second.as_array();
            const auto place = static_cast<std::size_t>(element->number);
            while (list.size() <= place) list.push_back(toml::table{});
            table = list[place].as_table();
            key = key.substr(key.rfind('.') + 1);
        } else if (const auto dot = key.find('.'); dot != key.npos) {
            table = &inner(whole, key.substr(0, dot));
            key = key.substr(dot + 1);
        }
        entry.value->visit([&](const auto& value) { table->insert_or_assign(key, value); });
    }
    std::ostringstream out;
    out << whole << '\n';
    return out.str();
}

}  // namespace mcdem::scene
