// The sealed file of a challenge: written first, opened last.
#pragma once
#include <filesystem>
#include <string>

#include "challenge/case.h"

namespace mcdem::inline challenge {

/// JSON; of the same challenge always the same bytes.
std::string truth_text(const Challenge& challenge);
Challenge parse_truth(const std::string& text, const std::string& file_name);

/// SHA-256 of a text: the seal.
std::string seal_of(const std::string& text);

/// Throws InputError where the file is missing or is not the one whose seal is given.
Challenge open_truth(const std::filesystem::path& file, const std::string& seal);

/// The word that stands for a kind in files and tables: none, effect, ...
std::string_view case_kind_name(CaseKind kind);

}  // namespace mcdem::challenge
