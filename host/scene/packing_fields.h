// Shared code of the packing readers: numbers from words, and a list of problems of limited length.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/packing.h"

namespace mcdem::inline scene {

/// The whole word as a number; nothing if characters remain or it is not finite.
std::optional<double> to_number(std::string_view word);
std::optional<long> to_whole_number(std::string_view word);

/// A word for use in messages: short, without control characters.
std::string quoted(std::string_view word);

/// Problems of one file, up to a maximum number.
class FileProblems {
public:
    explicit FileProblems(std::string source) : source_(std::move(source)) {}
    void add(long line, const std::string& what);
    void add(const std::string& what);
    bool full() const;
    bool empty() const { return problems_.empty(); }
    /// Throws InputError if there are problems.
    void report() const;

private:
    std::string source_;
    std::vector<std::string> problems_;
};

/// Reads the four numbers of a grain, reports invalid ones, and appends the grain to the packing.
void add_grain(Packing& packing, std::string_view x, std::string_view y, std::string_view z,
               std::string_view diameter, long line, FileProblems& problems);

/// Appends the name of the grain's species in the file.
void add_species(Packing& packing, std::string_view word);

}  // namespace mcdem::scene
