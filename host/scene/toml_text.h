// Parsing of TOML in scenes, experiments and results, safe for any input.
#pragma once
#include <toml++/toml.h>

#include <string_view>

namespace mcdem::inline scene {

/// toml::parse, which also throws toml::parse_error if names contain more than `max_dots` dots in total.
toml::table parse_toml(std::string_view text, std::string_view source = {}, std::size_t max_dots = 5000);

}  // namespace mcdem::scene
