// Tables as other programs and laboratories write them: text with any separator, dumps of LAMMPS and
// LIGGGHTS, text and VTK files of Yade. All become named columns, whose meaning and units are the reader's
// business.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/names.h"
#include "core/packing.h"
#include "scene/packing_fields.h"

namespace mcdem {

/// Bytes of a table, unpacked, that are read.
inline constexpr std::uintmax_t largest_foreign_table = std::uintmax_t{1} << 30;

enum class TableFormat { text, dump, vtk, data };
template <>
struct Names<TableFormat> {
    static constexpr std::array<std::string_view, 4> list{"text", "dump", "vtk", "data"};
};

/// How a text is cut into cells.
struct TextForm {
    char separator = ',';  ///< ' ' stands for any blanks
    char decimal = '.';
    bool operator==(const TextForm&) const = default;
};

class ForeignTable {
public:
    /// Rows that belong together, as a dump's timestep.
    struct Frame {
        long step = 0;
        std::size_t first_row = 0;
        long line = 0;
    };

    std::string file;
    TableFormat format = TableFormat::text;
    TextForm form;
    bool decimal_clear = true;         ///< else every comma may part thousands as well: 1,306
    bool named = false;                ///< the file names its columns; else they are "column 1", ..
    std::vector<std::string> columns;  ///< names, each once
    std::vector<Frame> frames;         ///< of a dump, in the order of the file; else empty

    std::size_t rows() const { return columns.empty() ? 0 : cells_.size() / columns.size(); }
    std::string_view cell(std::size_t row, std::size_t column) const;
    /// Nothing where the cell is no finite number.
    std::optional<double> number(std::size_t row, std::size_t column) const;
    std::optional<std::size_t> find(std::string_view name) const;
    /// "grains.dump:12", the row's place in the file: found by counting lines, for messages only.
    std::string where(std::size_t row) const;

    // For those who fill it: a row's cells must lie in `text`, and be as many as the columns.
    std::string text;
    void add_row(const std::vector<std::string_view>& cells);
    void name_columns(const std::vector<std::string>& names, std::size_t count);

private:
    struct Cell {
        std::uint32_t first, size;
    };
    std::vector<Cell> cells_;
};

/// Reads a file, packed with gzip or not, in the format that it turns out to have; `form` overrules the guess
/// of how a text is cut. Throws InputError with every problem found (the first 20), as `file:line: must be
/// .., got ..`.
ForeignTable read_foreign_table(const std::filesystem::path& file, const std::optional<TextForm>& form = {});

/// The same of bytes at hand; `file` names them in messages.
ForeignTable parse_foreign_table(std::string bytes, const std::string& file,
                                 const std::optional<TextForm>& form = {});

/// The grains of one frame of a dump (the last where `step` is left out) or of Yade's text: columns x, y, z
/// with radius (or r) or diameter, in metres. In the order of the column id, where there is one, else of the
/// rows.
Packing packing_of(const ForeignTable& table, std::optional<long> step = {});

// The formats, each in a file of its name. They fill a table that holds its text and file.
bool looks_like_dump(std::string_view text);
void parse_dump(ForeignTable& table, FileProblems& problems);
bool looks_like_vtk(std::string_view text);
void parse_vtk(ForeignTable& table, FileProblems& problems);
bool looks_like_yade(std::string_view text);
void parse_text(ForeignTable& table, const std::optional<TextForm>& form, FileProblems& problems);

}  // namespace mcdem
