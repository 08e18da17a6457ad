// What keys demand of each other.
#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scene/keys.h"

namespace mcdem::inline scene {

struct CrossProblem {
    std::string key;   ///< to blame, and begins the message
    std::string what;  ///< "must be .., got .."
};

/// Packing files that were read for checking, by path and frame: each is read once.
struct CheckedFile {
    std::size_t count = 0;
    double smallest = 0;  ///< diameter [m]
    Packing packing;
    std::vector<std::string> problems;  ///< of reading, each with its own place
};
using CheckedFiles = std::map<std::pair<std::string, int>, CheckedFile>;

/// Checks one setting. Keys in `bad` had problems of their own: what they demand of others is not checked.
std::vector<CrossProblem> cross_problems(const Settings& settings,
                                         const std::set<std::string, std::less<>>& bad);

/// Reads the packing file of the setting, if any, and checks that it fits. Problems name the file's lines.
std::vector<std::string> packing_file_problems(const Settings& settings, CheckedFiles& files);

/// Grains of one replica.
std::size_t grain_count(const Settings& settings, const CheckedFiles& files);

}  // namespace mcdem::scene
