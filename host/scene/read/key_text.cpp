// Texts about keys: allowed values, current values, and suggestions for unknown keys.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <utility>

#include "scene/read/list_tables.h"
#include "scene/read/toml_text.h"

namespace mcdem::inline scene {
namespace {

std::string number(double value, bool whole) {
    if (whole) return fmt::format("{}", static_cast<long long>(value));
    return fmt::format("{:g}", value);
}

std::string numbers(const Range& range, bool whole) {
    std::string text = whole ? "a whole number " : "a number ";
    if (range.low_end == Range::Low::excluded)
        text += fmt::format("> {} and <= {}", number(range.low, whole), number(range.high, whole));
    else
        text += fmt::format("between {} and {}", number(range.low, whole), number(range.high, whole));
    if (range.multiple_of > 1) text += fmt::format(", a multiple of {}", range.multiple_of);
    return text;
}

struct Describe {
    const Range& range;
    std::string operator()(MemberOf<double>) const { return numbers(range, false); }
    std::string operator()(MemberOf<int>) const { return numbers(range, true); }
    std::string operator()(MemberOf<std::uint64_t>) const { return numbers(range, true); }
    std::string operator()(MemberOf<bool>) const { return "true or false"; }
    std::string operator()(MemberOf<std::string>) const { return "text"; }
    std::string operator()(MemberOf<std::vector<double>>) const { return "a list of numbers"; }
    template <class Enum>
    std::string operator()(MemberOf<Enum>) const {
        return "one of " + all_names<Enum>();
    }
};

/// The value of a member as a parameter.
struct ValueOf {
    Settings& settings;
    Parameter operator()(MemberOf<double> get) const {
        return std::isnan(get(settings)) ? Parameter() : Parameter(get(settings));
    }
    Parameter operator()(MemberOf<int> get) const { return std::int64_t{get(settings)}; }
    Parameter operator()(MemberOf<std::uint64_t> get) const { return get(settings); }
    Parameter operator()(MemberOf<bool> get) const { return get(settings); }
    Parameter operator()(MemberOf<std::string> get) const {
        return get(settings).empty() ? Parameter() : Parameter(get(settings));
    }
    Parameter operator()(MemberOf<std::vector<double>> get) const {
        return get(settings).empty() ? Parameter() : Parameter(get(settings));
    }
    template <class Enum>
    Parameter operator()(MemberOf<Enum> get) const {
        return std::string(name(get(settings)));
    }
};

/// The parameter that a text means for a member of this type.
struct FromText {
    const std::string& text;
    Parameter operator()(MemberOf<double>) const { return number<double>(); }
    Parameter operator()(MemberOf<int>) const { return number<std::int64_t>(); }
    Parameter operator()(MemberOf<std::uint64_t>) const { return number<std::uint64_t>(); }
    Parameter operator()(MemberOf<bool>) const {
        return text == "true" || text == "false" ? Parameter(text == "true") : Parameter(text);
    }
    Parameter operator()(MemberOf<std::vector<double>>) const {
        const auto table = parse_value(text);
        const toml::array* list = table ? table->get("value")->as_array() : nullptr;
        if (!list) return text;
        std::vector<double> numbers;
        for (const toml::node& element : *list) {
            const auto number = element.value<double>();
            if (!number || !std::isfinite(*number)) return text;
            numbers.push_back(*number);
        }
        return numbers;
    }
    template <class Word>
    Parameter operator()(MemberOf<Word>) const {
        return without_quotes(text);
    }

private:
    template <class Number>
    Parameter number() const {
        Number value{};
        const char* const last = text.data() + text.size();
        const auto [end, error] = std::from_chars(text.data(), last, value);
        if (error == std::errc{} && end == last && std::isfinite(static_cast<double>(value))) return value;
        return of_another_program<Number>();
    }

    /// Other spellings of TOML: +0.05, 10.0 of a whole number.
    template <class Number>
    Parameter of_another_program() const {
        const auto table = parse_value(text);
        const auto number = table ? table->get("value")->value<double>() : std::nullopt;
        constexpr double most = 9e15;  // a whole number is exact
        if (!number || !std::isfinite(*number) || std::abs(*number) > most) return text;
        const auto value = static_cast<Number>(*number);
        return static_cast<double>(value) == *number ? Parameter(value) : Parameter(text);
    }
};

/// The parameter that a text of an unknown key, perhaps of another version, seems to mean.
Parameter guessed(const std::string& text) {
    if (text == "true" || text == "false") return text == "true";
    const auto is_all = [&](auto& number) {
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
        return error == std::errc{} && end == text.data() + text.size();
    };
    if (std::uint64_t whole = 0; is_all(whole)) return whole;
    if (std::int64_t whole = 0; is_all(whole)) return whole;
    if (double number = 0; is_all(number) && std::isfinite(number)) return number;
    return text;
}

/// Levenshtein distance: number of insertions, deletions and replacements between two words.
std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j + 1] + 1, row[j] + 1});
        }
    }
    return row.back();
}

}  // namespace

std::string_view last_part(std::string_view name) { return name.substr(name.rfind('.') + 1); }

std::string description(const Key& key) {
    std::string text = std::visit(Describe{key.range}, key.member);
    if (!key.unit.empty()) text += fmt::format(" [{}]", key.unit);
    return text;
}

Parameter value_of(const Key& key, const Settings& settings) {
    // Members are reached through a non-const reference; nothing is modified here.
    return std::visit(ValueOf{const_cast<Settings&>(settings)}, key.member);
}

std::string value_text(const Key& key, const Settings& settings) {
    return parameter_text(value_of(key, settings));
}

Parameters parameters_of(const ParameterTexts& texts) {
    Parameters all;
    for (const auto& [name, text] : texts) {
        const Key* key = find_key(name);
        all[name] = text.empty() ? Parameter()
                    : key        ? std::visit(FromText{text}, key->member)
                                 : guessed(text);
    }
    return all;
}

std::string suggestion(std::string_view unknown) {
    constexpr std::size_t longest = 64;  // longer words are not typing errors
    if (unknown.size() > longest) return "";
    std::string_view best;
    std::size_t least = std::max<std::size_t>(2, unknown.size() / 4) + 1;
    const auto consider = [&](std::string_view candidate, std::size_t far) {
        if (far >= least) return;
        least = far;
        best = candidate;
    };
    if (const auto element = list_element(unknown)) {
        for (const Key& key : element->keys()) consider(key.name, distance(unknown, key.name));
        return best.empty() ? "" : fmt::format(" (did you mean {}?)", best);
    }
    for (const ListTable& table : list_tables()) consider(table.name, distance(unknown, table.name));
    for (const Key& key : keys()) {
        consider(key.name, distance(unknown, key.name));
        const auto dot = key.name.find('.');
        if (unknown.find('.') == unknown.npos && dot != key.name.npos)
            consider(key.name.substr(0, dot), distance(unknown, key.name.substr(0, dot)));
        if (last_part(unknown) == last_part(key.name)) consider(key.name, 1);
    }
    return best.empty() ? "" : fmt::format(" (did you mean {}?)", best);
}

}  // namespace mcdem::scene
