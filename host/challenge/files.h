// challenge.json: the public data of a challenge, and the seal of its truth (tests/challenge/README.md).
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace mcdem::inline challenge {

struct OpenCase {
    std::string folder;  ///< of its experiment, in the folder of the challenge
    std::optional<std::vector<std::string>> candidates;  ///< effects that may be named; empty: all
};

struct OpenChallenge {
    std::string scene_sha256;   ///< of the scene's text
    std::string sealed_sha256;  ///< of the truth file
    std::vector<OpenCase> cases;
};

std::string open_challenge_text(const OpenChallenge& challenge);
/// Throws InputError if the folder does not contain a challenge.
OpenChallenge read_open_challenge(const std::filesystem::path& folder);

}  // namespace mcdem::challenge
