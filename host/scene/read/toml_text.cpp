#include "scene/read/toml_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

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

}  // namespace

toml::table parse_toml(std::string_view text, std::string_view source) {
    constexpr std::ptrdiff_t max_dots = 50'000;
    if (const auto dots = std::ranges::count(text, '.'); dots > max_dots)
        throw toml::parse_error(fmt::format("must have at most {} dots, got {}", max_dots, dots).c_str(),
                                toml::source_position{1, 1});
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
