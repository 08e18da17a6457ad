// Tables that a scene has several of, in order, such as [[programme]]. A key of the second [[species]] is
// called species.2.density.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/keys.h"

namespace mcdem::inline scene {

struct ListTable {
    std::string_view name;  ///< "species"
    int most;
    std::string_view elements;  ///< "species"; "stages" of a programme
    std::string_view says;      ///< what an element must say: "what the plate does"
    std::string_view remedy;    ///< .. and how
    std::span<const Key> (*keys)(int element);
    std::size_t (*size)(const Replica& replica);
};
std::span<const ListTable> list_tables();
const ListTable* find_list_table(std::string_view name);

/// Which element of which table a name such as "species.2" or "species.2.density" is about, from 0.
struct ListElement {
    const ListTable* table;
    int number;
    bool operator==(const ListElement&) const = default;
    std::span<const Key> keys() const { return table->keys(number); }
};
std::optional<ListElement> list_element(std::string_view name);

std::span<const Key> species_keys(int species);
std::span<const Key> pair_keys(int pair);

/// Element `n`, which is there from now on.
template <class Element>
Element& element(std::vector<Element>& list, std::size_t n) {
    if (list.size() <= n) list.resize(n + 1);
    return list[n];
}

/// The same rows for every element, with their whole names, which live as long as the program.
/// Rows::of<n>() gives those of element n.
template <class Rows, int most>
class ListKeys {
public:
    explicit ListKeys(std::string_view table) { fill(table, std::make_index_sequence<most>()); }
    std::span<const Key> of(int element) const { return keys_[static_cast<std::size_t>(element)]; }

private:
    template <std::size_t... n>
    void fill(std::string_view table, std::index_sequence<n...>) {
        (fill<n>(table), ...);
    }
    template <std::size_t n>
    void fill(std::string_view table) {
        keys_[n] = Rows::template of<n>();
        for (const Key& key : keys_[n])
            names_[n].push_back(std::string(table) + "." + std::to_string(n + 1) + "." +
                                std::string(key.name));
        for (std::size_t k = 0; k < keys_[n].size(); ++k) keys_[n][k].name = names_[n][k];
    }
    std::array<std::vector<Key>, most> keys_;
    std::array<std::vector<std::string>, most> names_;
};

}  // namespace mcdem::scene
