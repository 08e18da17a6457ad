// Tables that a scene can have several of, in order, such as [[programme]]. A key of the second [[species]]
// is called species.2.density.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/read/keys.h"

namespace mcdem::inline scene {

struct ListTable {
    std::string_view name;  ///< "species"
    int most;
    std::string_view elements;  ///< name of the elements in messages: "species"; "stages" of a programme
    std::string_view says;      ///< what an element must specify: "what the plate does"
    std::string_view remedy;    ///< keys that specify it
    std::span<const Key> (*keys)(int element);
    std::size_t (*size)(const Replica& replica);
};
std::span<const ListTable> list_tables();
const ListTable* find_list_table(std::string_view name);

/// Table and index (from 0) in a name such as "species.2" or "species.2.density".
struct ListElement {
    const ListTable* table;
    int number;
    bool operator==(const ListElement&) const = default;
    std::span<const Key> keys() const { return table->keys(number); }
};
std::optional<ListElement> list_element(std::string_view name);

std::span<const Key> species_keys(int species);
std::span<const Key> pair_keys(int pair);

/// Element `n`; creates it if necessary.
template <class Element>
Element& element(std::vector<Element>& list, std::size_t n) {
    if (list.size() <= n) list.resize(n + 1);
    return list[n];
}

}  // namespace mcdem::scene
