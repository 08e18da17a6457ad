#include "cli/shell/shell_words.h"

#include "core/replaced.h"

namespace mcdem::inline cli {

std::string shell_word(const std::string& word) {
    const auto plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./=:+,-";
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
    return "'" + replaced(word, {{'\'', "'\\''"}}) + "'";
}

std::string shell_words(const std::vector<std::string>& words) {
    std::string text;
    for (const auto& word : words) text += (text.empty() ? "" : " ") + shell_word(word);
    return text;
}

}  // namespace mcdem::cli
