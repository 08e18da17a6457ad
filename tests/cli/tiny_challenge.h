// Shared by the tests of challenges: a small scene, and arguments that make and run a challenge with it.
#pragma once
#include "cli/cli_test.h"

namespace mcdem {

using Words = std::vector<std::string>;

/// tiny.toml, the scene of the challenge: 64 grains, as dense as in the full challenge.
inline void write_tiny_scene(const std::filesystem::path& folder) {
    std::filesystem::copy_file(std::filesystem::path(MCDEM_SOURCE_DIR) / "tests/ensemble/tiny_challenge.toml",
                               folder / "tiny.toml");
}
inline constexpr int cases = 7;

inline const Words make_challenge_words = split(
    "challenge make tiny.toml --out challenge --seed 3 --effects friction,force_bias --none 2 --per-effect 1"
    " --pairs 0 --unknown 2 --outside 1 --packings 2");
inline const Words run_challenge_words = split(
    "challenge run challenge --scene tiny.toml --library library.json --out answers"
    " --candidates friction,force_bias --library-packings 8 --library-replicates 2 --replicates 3"
    " --confirmations 2");

/// The words, and further ones.
inline Words with(Words words, const std::string& more) {
    for (const std::string& word : split(more)) words.push_back(word);
    return words;
}

}  // namespace mcdem
