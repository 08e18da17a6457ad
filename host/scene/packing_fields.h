// What the packing readers share: numbers from words, and a list of problems that does not grow without end.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/packing.h"

namespace mcdem::inline scene {

/// The whole word as a number; nothing where anything is left over or it is not finite.
std::optional<double> to_number(std::string_view word);
std::optional<long> to_whole_number(std::string_view word);

/// A word as it may stand in a message: short, without control characters.
std::string quoted(std::string_view word);

/// Problems of one file, up to a number beyond which more would not help.
class FileProblems {
public:
    explicit FileProblems(std::string source) : source_(std::move(source)) {}
    void add(long line, const std::string& what);
    void add(const std::string& what);
    /// `where` is "file:line".
    void add_at(const std::string& where, const std::string& what);
    bool full() const;
    bool empty() const { return problems_.empty(); }
    /// Throws InputError where there are any.
    void report() const;

private:
    std::string source_;
    std::vector<std::string> problems_;
};

/// Reads the four numbers of a grain, reporting whichever is wrong, and appends it to the packing.
void add_grain(Packing& packing, std::string_view x, std::string_view y, std::string_view z,
               std::string_view diameter, long line, FileProblems& problems);

/// Appends what a file calls the species of a grain.
void add_species(Packing& packing, std::string_view word);

}  // namespace mcdem::scene
