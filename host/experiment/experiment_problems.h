// Problems of one experiment folder, up to a maximum number.
#pragma once
#include <set>
#include <string>
#include <vector>

namespace mcdem::inline experiment {

class ExperimentProblems {
public:
    /// `where` is a file, or file:line.
    void add(const std::string& where, const std::string& what);
    /// Adds only one problem for each `topic`: a column in millimetres is one problem, not one for each line.
    void add_once(const std::string& topic, const std::string& where, const std::string& what);
    /// True at the maximum; further problems are only counted.
    bool full() const;
    bool empty() const { return count_ == 0; }
    long count() const { return count_; }
    /// All problems, and the number of further ones.
    std::vector<std::string> lines() const;
    /// Throws InputError if there are problems.
    void report() const;

private:
    std::vector<std::string> first_;
    std::set<std::string> told_;
    long count_ = 0;
};

}  // namespace mcdem::experiment
