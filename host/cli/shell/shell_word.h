// Words as a shell takes them: what a user is told to type, and what a job script says.
#pragma once
#include <string>
#include <vector>

namespace mcdem::inline cli {

/// The word itself, in quotes where a shell would make something of it.
std::string shell_word(const std::string& word);
std::string shell_words(const std::vector<std::string>& words);

}  // namespace mcdem::cli
