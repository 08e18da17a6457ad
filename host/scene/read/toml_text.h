// TOML in scenes, experiments and results: parsing that is safe for any input, and assigning values to keys.
#pragma once
#include <toml++/toml.h>

#include <optional>
#include <string>
#include <string_view>

#include "scene/read/keys.h"

namespace mcdem::inline scene {

/// toml::parse, which also throws toml::parse_error if a name has more than 100 parts, or names, tables and
/// lists are nested more than 100 deep: parser and destructor are recursive, so some ten thousand overflow
/// the stack.
toml::table parse_toml(std::string_view text, std::string_view source = {});

/// A table with the single key "value"; nothing if the text is not a value of TOML.
std::optional<toml::table> parse_value(const std::string& text);

/// Sets the member of the key. Returns "must be .., got .." if the value is invalid.
std::optional<std::string> assign(const Key& key, const toml::node& value, Settings& settings);

/// A TOML value as text for messages: `0.5`, `"abc"`, `a table`.
std::string shown(const toml::node& value);

}  // namespace mcdem::scene
