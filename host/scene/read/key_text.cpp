// Texts about keys: allowed values, current values, and suggestions for unknown keys.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "scene/read/list_tables.h"

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

std::string text_of(const std::string& value) { return value; }
std::string text_of(bool value) { return value ? "true" : "false"; }
std::string text_of(double value) { return std::isnan(value) ? "" : fmt::format("{}", value); }
std::string text_of(const std::vector<double>& values) {
    return values.empty() ? "" : fmt::format("[{}]", fmt::join(values, ", "));
}
template <class Value>
std::string text_of(Value value) {
    if constexpr (std::is_enum_v<Value>)
        return std::string(name(value));
    else
        return fmt::format("{}", value);
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

std::string value_text(const Key& key, const Settings& settings) {
    // Members are reached through a non-const reference; nothing is modified here.
    auto& at = const_cast<Settings&>(settings);
    return std::visit([&](auto get) { return text_of(get(at)); }, key.member);
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
