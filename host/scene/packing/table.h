// One CSV table, plain or compressed with gzip, read row by row.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/packing/packing_fields.h"
#include "scene/read/problems.h"

namespace mcdem::inline scene {

/// `<folder>/<name>` or `<name>.gz`; nothing if neither exists. Problems: both exist, the file is not a
/// regular file, or it has more than `largest` bytes.
std::optional<std::filesystem::path> find_table(const std::filesystem::path& folder, const std::string& name,
                                                std::uintmax_t largest, FileProblems& problems);

class Table {
public:
    /// Reads the file and its header, in any order of columns. It must contain all `columns` and may contain
    /// the `optional` ones, which are numbered after them; others are ignored. An invalid byte and more than
    /// `largest` uncompressed bytes are problems. With `text` that is read instead of the file; it must
    /// outlive the table.
    Table(const std::filesystem::path& file, const std::vector<std::string>& columns, std::uintmax_t largest,
          FileProblems& problems, const std::vector<std::string>& optional = {},
          const std::string* text = nullptr);
    Table(const Table&) = delete;
    /// Advances to the next row with as many columns as the header. Returns false at the end or if the header
    /// is unusable; a table without rows is a problem. Empty lines and lines that start with # are skipped.
    bool next();

    /// Whether the header contains the column.
    bool has(std::size_t column) const;
    std::string_view text(std::size_t column) const { return words_[column]; }
    /// The number in a column; anything else is reported, and nothing is returned.
    std::optional<double> number(std::size_t column);
    std::optional<long> whole_number(std::size_t column, long least);
    long line() const { return line_; }
    /// "plate.csv:12", for the current row or another one.
    std::string where() const { return where(line_); }
    std::string where(long line) const;
    void problem(const std::string& what) { problem_at(where(), what); }
    void problem_at(const std::string& where, const std::string& what) { problems_.add(where, what); }
    /// Reports only one problem for each topic in this table.
    void problem_once(const std::string& topic, const std::string& what) {
        problems_.add_once(name_ + topic, where(), what);
    }
    std::string name() const { return name_; }
    /// Whether there are no problems so far.
    bool complete() const { return problems_.empty(); }

private:
    void read_header();
    /// The next line that is neither empty nor a comment.
    std::optional<std::string_view> next_line();
    std::string name_;
    std::vector<std::string> columns_;
    std::size_t needed_;  ///< number of required columns, which come first
    FileProblems& problems_;
    std::string text_;  ///< of the file
    std::optional<TextLines> lines_;
    std::vector<int> column_of_word_;  ///< by word of a line; -1: ignored
    std::vector<std::string_view> words_;
    long line_ = 1, rows_ = 0;
};

}  // namespace mcdem::scene
