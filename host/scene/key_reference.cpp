#include "scene/key_reference.h"

#include <fmt/format.h>

#include "scene/keys.h"

namespace mcdem::inline scene {

std::string key_reference() {
    Settings defaults;
    defaults.run.name.clear();  // the file's name stands in for it
    std::string text;
    std::string_view open = "none yet";
    for (const Key& key : keys()) {
        const auto dot = key.name.find('.');
        const std::string_view table = dot == key.name.npos ? "" : key.name.substr(0, dot);
        if (table != open) {
            text += table.empty() ? "### Before any table\n" : fmt::format("\n### [{}]\n", table);
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
