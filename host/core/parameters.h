// The scene keys of recordings with their values, as text.
#pragma once
#include <map>
#include <string>
#include <vector>

namespace mcdem::inline core {

using Parameters = std::map<std::string, std::string>;

/// The value of a key; empty where there is none.
std::string value_of(const Parameters& parameters, const std::string& key);

/// Whether the recording was taken through a [[programme]].
bool has_programme(const Parameters& parameters);

/// TOML writes words in quotes; parameters may hold them either way.
std::string without_quotes(const std::string& text);

/// Keys whose value is not the same in all, in alphabetical order.
std::vector<std::string> keys_that_vary(const std::vector<Parameters>& all);

}  // namespace mcdem::core
