// The sealed truth file of a challenge: written first, opened last.
#pragma once
#include <filesystem>
#include <string>

#include "challenge/case.h"

namespace mcdem::inline challenge {

/// JSON; bit-identical for the same challenge.
std::string truth_text(const Challenge& challenge);
Challenge parse_truth(const std::string& text, const std::string& file_name);

/// SHA-256 of a text: the seal.
std::string seal_of(const std::string& text);

/// Throws InputError if the file is missing or does not match the seal.
Challenge open_truth(const std::filesystem::path& file, const std::string& seal);

}  // namespace mcdem::challenge
