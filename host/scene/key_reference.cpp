#include "scene/key_reference.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/keys.h"

namespace mcdem::inline scene {

std::string key_reference() {
    Settings defaults;
    defaults.run.name.clear();  // the file's name stands in for it
    std::string text;
    std::string_view open = "none yet";
    std::vector<Key> all(keys().begin(), keys().end());
    all.insert(std::ranges::find(all, "numerics.time_step", &Key::name), stage_keys(0).begin(),
               stage_keys(0).end());
    for (const Key& key : all) {
        const auto dot = key.name.rfind('.');
        const std::string_view table = dot == key.name.npos ? "" : key.name.substr(0, key.name.find('.'));
        if (table != open) {
            text += table.empty() ? "### Before any table\n"
                                  : fmt::format("\n### [{}{}{}]\n", table == "programme" ? "[" : "", table,
                                                table == "programme" ? "]" : "");
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
