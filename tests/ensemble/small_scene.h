// A scene that runs quickly but has rearranging grains, two models and scans at rest.
#pragma once
#include <string>
#include <vector>

#include "core/test_folder.h"
#include "scene/read/read_scene.h"

namespace mcdem {

inline const std::string small_scene_text = R"(name = "small"
[box]
size_x = 0.06
size_y = 0.06
[packing]
count = 30
packing_fraction = 0.5
[plate]
start = 0.088
end = 0.078
[protocol]
scans_per_stroke = 4
stop_at_scans = true
rate_tolerance = 0
settle_time = 0.02
relax_time = 0.02
[batch.vary]
"contact.model" = ["independent", "elastic_sphere"]
)";

inline Scene small_scene(const std::vector<std::string>& overrides = {}) {
    return parse_scene(small_scene_text, "small.toml", overrides);
}

}  // namespace mcdem
