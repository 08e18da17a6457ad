// Text tables: aligned for a terminal, or Markdown.
#pragma once
#include <string>
#include <vector>

namespace mcdem::inline cli {

enum class TableFormat { terminal, markdown };
enum class Align { left, right };

struct TextTable {
    struct Column {
        std::string title;
        Align align = Align::right;
    };
    std::vector<Column> columns;
    std::vector<std::vector<std::string>> rows;  ///< as many cells as columns
    std::vector<std::string> notes;              ///< printed below
};

std::string to_text(const TextTable& table, TableFormat format);

}  // namespace mcdem::cli
