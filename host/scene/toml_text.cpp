#include "scene/toml_text.h"

#include <fmt/format.h>

namespace mcdem::inline scene {
namespace {

/// Number of dots that may belong to dotted names and not to decimal numbers. The parser is recursive in the
/// parts of a name, so a few hundred thousand would overflow the stack.
std::size_t dots_of_names(std::string_view text) {
    const auto digit = [&](std::size_t i) { return i < text.size() && text[i] >= '0' && text[i] <= '9'; };
    std::size_t count = 0;
    bool in_number = false;  // only digits since the previous dot
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '.') {
            const bool decimal = i > 0 && digit(i - 1) && digit(i + 1) && !in_number;
            if (!decimal) ++count;
            in_number = true;
        } else if (!digit(i)) {
            in_number = false;
        }
    }
    return count;
}

}  // namespace

toml::table parse_toml(std::string_view text, std::string_view source, std::size_t max_dots) {
    if (const std::size_t dots = dots_of_names(text); dots > max_dots)
        throw toml::parse_error(
            fmt::format("must have at most {} dots besides those of numbers, got {}", max_dots, dots).c_str(),
            toml::source_position{1, 1});
    return toml::parse(text, source);
}

}  // namespace mcdem::scene
