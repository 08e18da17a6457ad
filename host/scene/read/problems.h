// Problems of one scene with their places, reported in the order of the file; problems of other files.
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

/// Problems of a file or a folder in the order in which they are found, up to a maximum number.
class FileProblems {
public:
    /// `source`: file of the problems that are added without its name.
    explicit FileProblems(std::string source = {}) : source_(std::move(source)) {}
    /// `where` is a file, or file:line. Problems beyond the maximum are only counted.
    void add(const std::string& where, const std::string& what);
    /// In a line of the source, or in the whole; ignored beyond the maximum.
    void add(long line, const std::string& what);
    void add(const std::string& what);
    /// True at the maximum.
    bool full() const;
    bool empty() const { return count_ == 0; }
    long count() const { return count_; }
    /// All problems, and the number of further ones.
    std::vector<std::string> lines() const;
    /// Throws InputError if there are problems.
    void report() const;

private:
    std::string source_;
    std::vector<std::string> first_;
    long count_ = 0;
};

/// A user's word for use in messages: short, without control characters.
std::string shortened(const std::string& text, std::size_t longest = 80);

}  // namespace mcdem::scene
