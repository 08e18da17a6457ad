// Iteration over the lines of a text.
#pragma once
#include <algorithm>
#include <optional>
#include <string_view>
#include <vector>

namespace mcdem::inline scene {

class TextLines {
public:
    explicit TextLines(std::string_view text) : rest_(text) {}
    /// The next line without its line end (Unix or Windows); nothing after the last one.
    std::optional<std::string_view> next() {
        if (rest_.empty()) return std::nullopt;
        const std::size_t end = std::min(rest_.find('\n'), rest_.size());
        std::string_view line = rest_.substr(0, end);
        rest_.remove_prefix(std::min(end + 1, rest_.size()));
        if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        ++number_;
        return line;
    }
    long number() const { return number_; }

private:
    std::string_view rest_;
    long number_ = 0;
};

inline std::string_view without_blanks(std::string_view text) {
    constexpr std::string_view blank = " \t\r";
    const auto first = text.find_first_not_of(blank);
    if (first == text.npos) return text.substr(0, 0);
    return text.substr(first, text.find_last_not_of(blank) - first + 1);
}

/// Splits a line at blanks.
inline void split_at_blanks(std::string_view line, std::vector<std::string_view>& words) {
    constexpr std::string_view blank = " \t\r";
    words.clear();
    for (std::size_t begin = line.find_first_not_of(blank); begin != line.npos;) {
        const std::size_t end = std::min(line.find_first_of(blank, begin), line.size());
        words.push_back(line.substr(begin, end - begin));
        begin = line.find_first_not_of(blank, end);
    }
}

}  // namespace mcdem::scene
