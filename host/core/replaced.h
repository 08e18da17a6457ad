// Text with some of its characters written in another way: escapes of HTML, shells, tables.
#pragma once
#include <algorithm>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace mcdem::inline core {

inline std::string replaced(std::string_view text,
                            std::initializer_list<std::pair<char, std::string_view>> characters) {
    std::string all;
    for (const char c : text) {
        const auto* found = std::ranges::find(characters, c, &std::pair<char, std::string_view>::first);
        found == characters.end() ? all += c : all += found->second;
    }
    return all;
}

}  // namespace mcdem::core
