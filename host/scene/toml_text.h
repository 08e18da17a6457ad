// TOML of scenes, experiments and results, of which none may end the program.
#pragma once
#include <toml++/toml.h>

#include <string_view>

namespace mcdem::inline scene {

/// toml::parse, which also throws toml::parse_error where names have more than `max_dots` dots in all.
toml::table parse_toml(std::string_view text, std::string_view source = {}, std::size_t max_dots = 5000);

}  // namespace mcdem::scene
