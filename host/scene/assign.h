// From a TOML value to the member that a key stands for.
#pragma once
#include <toml++/toml.h>

#include <optional>
#include <string>

#include "scene/keys.h"

namespace mcdem::inline scene {

/// Sets the key's member. Returns "must be .., got .." where the value is not what the key takes.
std::optional<std::string> assign(const Key& key, const toml::node& value, Settings& settings);

/// A TOML value as it may stand in a message: `0.5`, `"abc"`, `a table`.
std::string shown(const toml::node& value);

}  // namespace mcdem::scene
