// What the tests of challenges share: a small scene, and the words that make and run a challenge of it.
#pragma once
#include "cli/cli_test.h"

namespace mcdem {

using Words = std::vector<std::string>;

/// 64 grains, as dense as the challenge's.
inline const char* const tiny_scene_text = R"(name = "tiny"
[box]
size_x = 0.083
size_y = 0.083
[contact]
model = "independent"
friction_law = "mindlin"
[packing]
count = 64
packing_fraction = 0.59
[plate]
start = 0.0835
end = 0.0685
speed = 0.2
[protocol]
stop_at_scans = false
scans_per_stroke = 6
relax_time = 0.1
)";
inline constexpr int cases = 7;

inline const Words make_challenge_words{"challenge", "make",       "tiny.toml",
                                        "--out",     "challenge",  "--seed",
                                        "3",         "--effects",  "friction,force_bias",
                                        "--none",    "2",          "--per-effect",
                                        "1",         "--pairs",    "0",
                                        "--unknown", "2",          "--outside",
                                        "1",         "--packings", "2"};
inline const Words run_challenge_words{"challenge",
                                       "run",
                                       "challenge",
                                       "--scene",
                                       "tiny.toml",
                                       "--library",
                                       "library.json",
                                       "--out",
                                       "answers",
                                       "--candidates",
                                       "friction,force_bias",
                                       "--library-packings",
                                       "8",
                                       "--library-replicates",
                                       "2",
                                       "--replicates",
                                       "3",
                                       "--confirmations",
                                       "2"};

}  // namespace mcdem
