// One CSV table, read row by row.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/packing/packing_fields.h"
#include "scene/read/problems.h"

namespace mcdem::inline scene {

class Table {
public:
    /// Reads the header, with columns in any order. It must contain all `columns` and may contain the
    /// `optional` ones, which are numbered after them; others are ignored. `name`: of the file in problems.
    /// The text must outlive the table; zero bytes in it are a problem.
    Table(std::string name, std::string_view text, const std::vector<std::string>& columns,
          FileProblems& problems, const std::vector<std::string>& optional = {});
    Table(const Table&) = delete;
    /// Advances to the next row with as many columns as the header. Returns false at the end or if the header
    /// is unusable; a table without rows is a problem. Empty lines and lines that start with # are skipped.
    bool next();

    /// Names in the header that are none of the columns.
    const std::vector<std::string>& others() const { return others_; }
    /// Whether the header contains the column.
    bool has(std::size_t column) const;
    std::string_view text(std::size_t column) const { return words_[column]; }
    /// The number in a column; anything else is reported, and nothing is returned.
    std::optional<double> number(std::size_t column);
    std::optional<long> whole_number(std::size_t column, long least);
    long line() const { return line_; }
    /// Of the current row.
    void problem(const std::string& what);

private:
    void read_header();
    /// The next line that is neither empty nor a comment.
    std::optional<std::string_view> next_line();
    std::string name_;
    std::vector<std::string> columns_, others_;
    std::size_t needed_;  ///< number of required columns, which come first
    FileProblems& problems_;
    std::optional<TextLines> lines_;
    std::vector<int> column_of_word_;  ///< by word of a line; -1: ignored
    std::vector<std::string_view> words_;
    long line_ = 1, rows_ = 0;
};

}  // namespace mcdem::scene
