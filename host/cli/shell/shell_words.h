// Words of a command line, as a shell reads them.
#pragma once
#include <string>
#include <vector>

namespace mcdem::inline cli {

/// The word, in quotes if a shell would interpret it.
std::string shell_word(const std::string& word);
std::string shell_words(const std::vector<std::string>& words);

}  // namespace mcdem::cli
