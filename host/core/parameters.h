// Scene keys of a recording with their values, as text.
#pragma once
#include <map>
#include <string>
#include <vector>

namespace mcdem::inline core {

using Parameters = std::map<std::string, std::string>;

/// The value of a key; empty if it is missing.
std::string value_of(const Parameters& parameters, const std::string& key);

/// Whether the recording followed a [[programme]].
bool has_programme(const Parameters& parameters);

/// Removes the quotes of a TOML string; parameters may contain them or not.
std::string without_quotes(const std::string& text);

/// Keys with different values among these, in alphabetical order.
std::vector<std::string> keys_that_vary(const std::vector<Parameters>& all);
/// The same among the parameters of recordings or replicas.
template <class Owner>
std::vector<std::string> keys_that_vary(const std::vector<Owner>& owners) {
    std::vector<Parameters> all;
    for (const Owner& owner : owners) all.push_back(owner.parameters);
    return keys_that_vary(all);
}

}  // namespace mcdem::core
