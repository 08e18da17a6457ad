#include "scene/read/toml_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

#include "scene/read/problems.h"

namespace mcdem::inline scene {
namespace {

/// One overload per type of member; returns true if the value was accepted.
struct Assign {
    const Key& key;
    const toml::node& value;
    Settings& settings;

    bool operator()(MemberOf<double> get) const {
        const auto number = value.is_number() ? value.value<double>() : std::nullopt;
        if (!number || !key.range.contains(*number)) return false;
        get(settings) = *number;
        return true;
    }
    bool operator()(MemberOf<int> get) const { return whole(get); }
    bool operator()(MemberOf<std::uint64_t> get) const { return whole(get); }
    bool operator()(MemberOf<bool> get) const {
        if (!value.is_boolean()) return false;
        get(settings) = value.as_boolean()->get();
        return true;
    }
    bool operator()(MemberOf<std::string> get) const {
        constexpr std::size_t longest = 4096;
        if (!value.is_string()) return false;
        const std::string& text = value.as_string()->get();
        const bool printable = std::ranges::none_of(text, [](unsigned char c) { return c < 32 || c == 127; });
        if (text.empty() || text.size() > longest || !printable) return false;
        get(settings) = text;
        return true;
    }
    bool operator()(MemberOf<std::vector<double>> get) const {
        constexpr std::size_t longest = 10000;
        const toml::array* list = value.as_array();
        if (!list || list->empty() || list->size() > longest) return false;
        std::vector<double> numbers;
        for (const toml::node& element : *list) {
            const auto number = element.is_number() ? element.value<double>() : std::nullopt;
            if (!number || !std::isfinite(*number)) return false;
            numbers.push_back(*number);
        }
        get(settings) = std::move(numbers);
        return true;
    }
    template <class Enum>
    bool operator()(MemberOf<Enum> get) const {
        const auto word = value.is_string() ? parse<Enum>(value.as_string()->get()) : std::nullopt;
        if (word) get(settings) = *word;
        return word.has_value();
    }

private:
    template <class Whole>
    bool whole(MemberOf<Whole> get) const {
        const auto assign = [&](auto number) {
            if (!key.range.contains(static_cast<double>(number))) return false;
            get(settings) = static_cast<Whole>(number);
            return true;
        };
        if (value.is_integer()) return assign(value.as_integer()->get());
        if (!value.is_floating_point()) return false;
        const double number = value.as_floating_point()->get();  // such as 60.0
        return number == std::trunc(number) && assign(number);
    }
};

/// The position after the string that begins here; of a text that is no TOML, any position after this one.
std::size_t end_of_string(std::string_view text, std::size_t first) {
    const char quote = text[first];
    const bool is_long = text.substr(first, 3) == std::string(3, quote);
    for (std::size_t at = first + (is_long ? 3 : 1); at < text.size(); ++at) {
        if (quote == '"' && text[at] == '\\')
            ++at;
        else if (!is_long && (text[at] == quote || text[at] == '\n'))
            return at + 1;
        else if (is_long && text.substr(at, 3) == std::string(3, quote)) {
            at += 3;
            for (int more = 0; more < 2 && at < text.size() && text[at] == quote; ++more)
                ++at;  // of the content
            return at;
        }
    }
    return text.size();
}

/// Throws toml::parse_error if names and values are nested so deeply that the recursive parser, or the
/// destructor of what it made, could overflow the stack. Counts the parts of dotted names and open brackets
/// of the text up to its first syntax error.
void expect_shallow(std::string_view text) {
    constexpr std::size_t deepest = 100;
    std::vector<std::size_t> outside;  // depth outside each open bracket
    std::size_t depth = 0, dots = 0, dots_of_key = 0;
    toml::source_index line = 1;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const char sign = text[at];
        if (sign == '"' || sign == '\'') {
            const std::size_t end = end_of_string(text, at);
            line += static_cast<toml::source_index>(std::ranges::count(text.substr(at, end - at), '\n'));
            at = end - 1;
        } else if (sign == '#') {
            at = std::min(text.find('\n', at), text.size()) - 1;
        } else if (sign == '.') {
            ++dots;
        } else if (sign == '=') {
            dots_of_key = std::exchange(dots, 0);
        } else if (sign == '[' || sign == '{') {
            outside.push_back(depth);
            depth += std::exchange(dots_of_key, 0) + 1;
            dots = 0;
        } else if ((sign == ']' || sign == '}') && !outside.empty()) {
            depth = outside.back();
            outside.pop_back();
            dots = 0;
        } else if (sign == ',' || sign == '\n') {
            dots = dots_of_key = 0;
            line += sign == '\n' ? 1 : 0;
        }
        if (depth + dots >= deepest)
            throw toml::parse_error(
                fmt::format("names must have at most {} parts, and values must be nested at most {} deep",
                            deepest, deepest)
                    .c_str(),
                toml::source_position{line, 1});
    }
}

}  // namespace

toml::table parse_toml(std::string_view text, std::string_view source) {
    expect_shallow(text);
    return toml::parse(text, source);
}

std::optional<toml::table> parse_value(const std::string& text) {
    try {
        return parse_toml("value = " + text);
    } catch (const toml::parse_error&) {
        return std::nullopt;
    }
}

std::optional<std::string> assign(const Key& key, const toml::node& value, Settings& settings) {
    if (std::visit(Assign{key, value, settings}, key.member)) return std::nullopt;
    return fmt::format("must be {}, got {}", description(key), shown(value));
}

std::string shown(const toml::node& value) {
    if (value.is_table()) return "a table";
    if (value.is_array()) return value.as_array()->empty() ? "an empty list" : "a list";
    if (value.is_string()) return fmt::format("\"{}\"", shortened(value.as_string()->get()));
    if (value.is_floating_point()) return fmt::format("{}", value.as_floating_point()->get());
    std::ostringstream out;
    value.visit([&](const auto& concrete) {
        if constexpr (toml::is_value<decltype(concrete)>) out << concrete;
    });
    return shortened(out.str());
}

}  // namespace mcdem::scene
