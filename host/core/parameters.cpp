#include "core/parameters.h"

#include <set>

namespace mcdem::inline core {

std::string value_of(const Parameters& parameters, const std::string& key) {
    const auto found = parameters.find(key);
    return found == parameters.end() ? "" : found->second;
}

bool has_programme(const Parameters& parameters) { return parameters.contains("programme.1.stage"); }

std::string without_quotes(const std::string& text) {
    const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
    return quoted ? text.substr(1, text.size() - 2) : text;
}

std::vector<std::string> keys_that_vary(const std::vector<Parameters>& all) {
    std::set<std::string> keys, varying;
    for (const auto& parameters : all)
        for (const auto& [key, value] : parameters) keys.insert(key);
    for (const auto& key : keys)
        for (const auto& parameters : all)
            if (value_of(parameters, key) != value_of(all.front(), key)) varying.insert(key);
    return {varying.begin(), varying.end()};
}

}  // namespace mcdem::core
