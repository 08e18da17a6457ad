// One CSV table of an experiment, plain or packed with gzip, read row by row.
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiment/experiment_problems.h"

namespace mcdem::inline experiment {

/// `<folder>/<name>` or `<name>.gz`; nothing where neither is there. Problems: both (which counts?), one that
/// is no ordinary file, one of more than `largest` bytes.
std::optional<std::filesystem::path> find_table(const std::filesystem::path& folder, const std::string& name,
                                                std::uintmax_t largest, ExperimentProblems& problems);

class Table {
public:
    /// Opens the file and reads its header, which must name all `columns` and may name the `optional` ones,
    /// which count on from them, in any order; others are left aside. Reading ends with a problem at a byte
    /// that no text has, and after `largest` unpacked bytes.
    Table(const std::filesystem::path& file, const std::vector<std::string>& columns, std::uintmax_t largest,
          ExperimentProblems& problems, const std::vector<std::string>& optional = {});
    ~Table();
    /// Goes on to the next row that has as many columns as the header; false at the end or where the header
    /// is unusable; none at all is a problem. Lines that are empty or start with # are skipped.
    bool next();

    /// Whether the header names the column.
    bool has(std::size_t column) const;
    std::string_view text(std::size_t column) const { return words_[column]; }
    /// The number in a column; anything else is reported, and nothing given.
    std::optional<double> number(std::size_t column);
    std::optional<long> whole_number(std::size_t column, long least);
    long line() const { return line_; }
    /// "plate.csv:12", the present row or another.
    std::string where() const { return where(line_); }
    std::string where(long line) const;
    void problem(const std::string& what) { problem_at(where(), what); }
    void problem_at(const std::string& where, const std::string& what) { problems_.add(where, what); }
    /// The same, told once for each topic in this table.
    void problem_once(const std::string& topic, const std::string& what) {
        problems_.add_once(name_ + topic, where(), what);
    }
    std::string name() const { return name_; }
    /// Whether nothing was wrong with it so far.
    bool complete() const { return problems_.empty(); }

private:
    class Lines;
    void read_header();
    std::string name_;
    std::vector<std::string> columns_;
    std::size_t needed_;  ///< of them, the first
    ExperimentProblems& problems_;
    std::unique_ptr<Lines> lines_;
    std::vector<int> column_of_word_;  ///< by word of a line; -1: left aside
    std::vector<std::string_view> words_;
    long line_ = 1, rows_ = 0;
};

}  // namespace mcdem::experiment
