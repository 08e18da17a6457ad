// challenge.json: what a diagnosis of the challenge may know, and the seal of what it may not
// (tests/challenge/README.md).
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace mcdem::inline challenge {

struct OpenCase {
    std::string folder;                                  ///< of its experiment, in the challenge's
    std::optional<std::vector<std::string>> candidates;  ///< effects that may be named; nothing: all
};

struct OpenChallenge {
    std::string scene;   ///< SHA-256 of the scene's text
    std::string sealed;  ///< SHA-256 of the file that tells the answers
    std::vector<OpenCase> cases;
};

std::string open_challenge_text(const OpenChallenge& challenge);
/// Throws InputError where the folder holds no challenge.
OpenChallenge read_open_challenge(const std::filesystem::path& folder);

}  // namespace mcdem::challenge
