// Problems of one scene with their places, reported in the order of the file.
#pragma once
#include <climits>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace mcdem::inline scene {

/// Place of a key: a line of the file, or an override.
struct Place {
    std::string text;  ///< "compression.toml:12", "--set grains.friction"
    int line = 0;      ///< for sorting; 0: the whole file
    int column = 0;
    static Place override_of(const std::string& key) { return {"--set " + key, INT_MAX, 0}; }
};

class Problems {
public:
    /// The same problem at the same place is added once.
    void add(const Place& place, const std::string& what);
    bool empty() const { return found_.empty(); }
    /// Throws InputError with all problems, if there are any.
    void report() const;

private:
    std::set<std::pair<std::pair<int, int>, std::string>> found_;
};

/// A user's word for use in messages: short, without control characters.
std::string shortened(const std::string& text);

}  // namespace mcdem::scene
