// Creates the replicas of a run: combinations of the variations, times the copies.
#pragma once
#include <toml++/toml.h>

#include <string>
#include <vector>

#include "scene/read/keys.h"

namespace mcdem::inline scene {

/// Maximum number of replicas in a run, and of grains in all of them.
inline constexpr double max_replicas = 10'000;
inline constexpr double max_grains = 10'000'000;

/// One line of [batch.vary], with checked values.
struct Variation {
    const Key* key;
    std::vector<const toml::node*> values;
};

/// One combination of the varied values.
struct Combination {
    Settings settings;
    std::string label;  ///< "mc_dem, friction=0.03"; empty if nothing varies
};

/// Number of combinations, computed without creating them.
double combination_count(const std::vector<Variation>& variations);

/// All combinations; the first variation changes slowest.
std::vector<Combination> combinations(const Settings& base, const std::vector<Variation>& variations);

/// Times that the scene does not give follow from the grains, the smallest of which has this diameter [m].
void set_times(Settings& settings, double smallest_diameter);

/// The copies of every combination. Copy n has the same packing seed in all combinations, so that settings
/// can be compared on equal packings.
std::vector<Replica> make_replicas(const std::vector<Combination>& combinations);

}  // namespace mcdem::scene
