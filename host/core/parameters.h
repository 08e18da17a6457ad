// Scene keys of a recording with their values. Files and tables have them as text.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace mcdem::inline core {

/// Value of a key; words are text. std::monostate: not given, or the key does not apply.
using Parameter =
    std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, std::string, std::vector<double>>;
using Parameters = std::map<std::string, Parameter>;
using ParameterTexts = std::map<std::string, std::string>;

/// The value of a key; std::monostate if it is missing.
const Parameter& find_parameter(const Parameters& parameters, const std::string& key);

/// As in result files: numbers are exact when read back; empty if not given.
std::string parameter_text(const Parameter& value);
ParameterTexts parameter_texts(const Parameters& parameters);

/// Whether a number is written without a decimal point or an exponent, as a whole one.
bool is_written_whole(double value);

/// Whether the recording followed a [[programme]].
bool has_programme(const Parameters& parameters);

/// Removes the quotes of a TOML string, which files of earlier versions have.
std::string without_quotes(const std::string& text);

/// Keys with different values among these, in alphabetical order.
std::vector<std::string> keys_that_vary(const std::vector<Parameters>& all);

}  // namespace mcdem::core
