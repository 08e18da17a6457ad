#include "core/parameters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <set>

namespace mcdem::inline core {
namespace {

struct ParameterText {
    std::string operator()(std::monostate) const { return ""; }
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    std::string operator()(const std::string& value) const { return value; }
    std::string operator()(const std::vector<double>& values) const {
        return fmt::format("[{}]", fmt::join(values, ", "));
    }
    template <class Number>
    std::string operator()(Number value) const {
        return fmt::format("{}", value);
    }
};

}  // namespace

const Parameter& find_parameter(const Parameters& parameters, const std::string& key) {
    static const Parameter missing;
    const auto found = parameters.find(key);
    return found == parameters.end() ? missing : found->second;
}

std::string parameter_text(const Parameter& value) { return std::visit(ParameterText{}, value); }

ParameterTexts parameter_texts(const Parameters& parameters) {
    ParameterTexts texts;
    for (const auto& [key, value] : parameters) texts[key] = parameter_text(value);
    return texts;
}

bool is_written_whole(double value) { return value == std::trunc(value) && std::abs(value) < 1e16; }

bool has_programme(const Parameters& parameters) { return parameters.contains("programme.1.stage"); }

std::string without_quotes(const std::string& text) {
    const bool quoted = text.size() >= 2 && text.front() == '"' && text.back() == '"';
    return quoted ? text.substr(1, text.size() - 2) : text;
}

std::vector<std::string> keys_that_vary(const std::vector<Parameters>& all) {
    std::set<std::string> varying;
    for (const auto& parameters : all)
        for (const Parameters* some : {&parameters, &all.front()})  // each may lack keys of the other
            for (const auto& [key, value] : *some)
                if (find_parameter(parameters, key) != find_parameter(all.front(), key)) varying.insert(key);
    return {varying.begin(), varying.end()};
}

}  // namespace mcdem::core
