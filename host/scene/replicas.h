// From one setting to the replicas of a run: the variations, times the copies.
#pragma once
#include <toml++/toml.h>

#include <string>
#include <vector>

#include "scene/keys.h"

namespace mcdem::inline scene {

/// The most replicas in a run, and grains in all of them.
inline constexpr double max_replicas = 10'000;
inline constexpr double max_grains = 10'000'000;

/// One line of [batch.vary], its values checked.
struct Variation {
    const Key* key;
    std::vector<const toml::node*> values;
};

/// One point of the variations' product.
struct Combination {
    Settings settings;
    std::string label;  ///< "mc_dem, friction=0.03"; empty where nothing varies
};

/// How many combinations there are, without making them.
double combination_count(const std::vector<Variation>& variations);

/// All combinations, the first variation changing slowest.
std::vector<Combination> combinations(const Settings& base, const std::vector<Variation>& variations);

/// The copies of every combination, copy n of each with the same packing seed, so that settings can be
/// compared in pairs.
std::vector<Replica> make_replicas(const std::vector<Combination>& combinations);

}  // namespace mcdem::scene
