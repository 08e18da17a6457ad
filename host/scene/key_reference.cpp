#include "scene/key_reference.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/list_tables.h"

namespace mcdem::inline scene {

std::string key_reference() {
    Settings defaults;
    defaults.run.name.clear();  // the default is the file's name
    std::string text;
    std::string_view open = "none yet";
    std::vector<Key> all(keys().begin(), keys().end());
    const auto put_before = [&](std::string_view next, std::span<const Key> keys) {
        all.insert(std::ranges::find(all, next, &Key::name), keys.begin(), keys.end());
    };
    put_before("walls.youngs_modulus", species_keys(0));
    put_before("walls.youngs_modulus", pair_keys(0));
    put_before("numerics.time_step", stage_keys(0));
    for (const Key& key : all) {
        const auto dot = key.name.rfind('.');
        const std::string_view table = dot == key.name.npos ? "" : key.name.substr(0, key.name.find('.'));
        if (table != open) {
            text += table.empty()
                        ? "### Before any table\n"
                        : fmt::format("\n### {1}{0}{2}\n", table, find_list_table(table) ? "[[" : "[",
                                      find_list_table(table) ? "]]" : "]");
            text += "\n| key | must be | default | meaning |\n|---|---|---|---|\n";
            open = table;
        }
        const std::string value = value_text(key, defaults);
        text += fmt::format("| `{}` | {} | {} | {} |\n", key.name.substr(dot == key.name.npos ? 0 : dot + 1),
                            description(key), value.empty() ? "none" : "`" + value + "`", key.meaning);
    }
    return text;
}

}  // namespace mcdem::scene
