#include "scene/list_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace mcdem::inline scene {

std::span<const ListTable> list_tables() {
    static const ListTable all[] = {
        {"species", max_species, "species", "what its grains are",
         "name, and its share of the grains, its material or its sizes", species_keys,
         [](const Replica& replica) { return replica.species.size(); }},
        {"pair", max_pairs, "pairs", "how two species meet",
         "first and second, and their friction or restitution", pair_keys,
         [](const Replica& replica) { return replica.pairs.size(); }},
        {"programme", max_stages, "stages", "what the plate does",
         "position, strain or force of a move, or stage = hold, cycle or repeat with their keys", stage_keys,
         [](const Replica& replica) { return replica.programme.size(); }},
    };
    return all;
}

const ListTable* find_list_table(std::string_view name) {
    const auto tables = list_tables();
    const auto found = std::ranges::find(tables, name, &ListTable::name);
    return found == tables.end() ? nullptr : &*found;
}

ListKeys::ListKeys(std::string_view table, int most, std::span<const Key> rows) {
    for (std::size_t n = 0; n < static_cast<std::size_t>(most); ++n) {
        std::vector<Key>& keys = keys_.emplace_back(rows.begin(), rows.end());
        for (Key& key : keys) {
            key.name = names_.emplace_back(fmt::format("{}.{}.{}", table, n + 1, key.name));
            std::visit([&](auto& member) { member.element = n; }, key.member);
        }
    }
}

std::optional<ListElement> list_element(std::string_view name) {
    const auto dot = name.find('.');
    const ListTable* table = find_list_table(name.substr(0, dot));
    if (!table || dot == name.npos) return std::nullopt;
    name = name.substr(dot + 1);
    name = name.substr(0, name.find('.'));
    int number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    const bool plain = error == std::errc{} && end == name.data() + name.size() && name.front() != '0';
    if (!plain || number < 1 || number > table->most) return std::nullopt;
    return ListElement{table, number - 1};
}

int stage_of(std::string_view name) {
    const auto element = list_element(name);
    return element && element->table->name == "programme" ? element->number : -1;
}

}  // namespace mcdem::scene
