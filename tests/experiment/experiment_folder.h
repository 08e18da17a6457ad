// A small experiment folder as texts, so that a test can change one line.
#pragma once
#include <filesystem>
#include <map>
#include <string>

#include "core/errors.h"
#include "experiment/experiment.h"

namespace mcdem::test {

/// Two grains side by side on the floor of a box 40 mm wide, compressed by the plate in three frames.
class ExperimentFolder {
public:
    ExperimentFolder();
    ~ExperimentFolder();
    std::string& operator[](const std::string& name) { return texts_[name]; }
    void remove(const std::string& name) { texts_.erase(name); }
    /// Replaces the first `from` in a file; fails the test if there is none.
    void replace(const std::string& name, const std::string& from, const std::string& to);
    /// Writes the files and reads the folder.
    Experiment read();
    void write() const;
    /// Writes and reads the files; returns the error message without the folder's path, or "no error".
    std::string error();
    /// The same for the files that are in the folder.
    std::string error_as_it_lies(std::uintmax_t largest = largest_table) const;
    const std::filesystem::path& path() const { return path_; }

private:
    std::map<std::string, std::string> texts_;
    std::filesystem::path path_;
};

}  // namespace mcdem::test
