// Assigns TOML values to the members of keys.
#pragma once
#include <toml++/toml.h>

#include <optional>
#include <string>

#include "scene/keys.h"

namespace mcdem::inline scene {

/// Sets the member of the key. Returns "must be .., got .." if the value is invalid.
std::optional<std::string> assign(const Key& key, const toml::node& value, Settings& settings);

/// A TOML value as text for messages: `0.5`, `"abc"`, `a table`.
std::string shown(const toml::node& value);

}  // namespace mcdem::scene
