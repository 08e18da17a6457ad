// VTK's legacy format in ASCII with polygonal data, as Yade's VTKExporter writes spheres (exportSpheres),
// contact points (exportContactPoints) and interactions (exportInteractions). A row is a point with its data:
// x y z, then every field by its name, a vector as name_x, name_y, name_z. Where there are lines, a row is a
// line with the data of its cell: x1 y1 z1 x2 y2 z2 of its two ends first.
// https://docs.vtk.org/en/latest/design_documents/VTKFileFormats.html
#include <fmt/format.h>

#include <array>

#include "scene/foreign_table.h"
#include "scene/text_lines.h"

namespace mcdem {
namespace {

constexpr long most_numbers = 100'000'000;

class VtkParser {
public:
    VtkParser(ForeignTable& table, FileProblems& problems)
        : table_(table), problems_(problems), lines_(table.text) {}

    void parse() {
        lines_.next();
        lines_.next();  // a title
        if (!next() || words_.size() != 1 || words_[0] != "ASCII")
            return wrong("the format must be ASCII: write the file as text");
        while (problems_.empty() && next()) section();
        if (!problems_.empty()) return;
        if (points_.empty()) return problems_.add("must hold POINTS, got none");
        if (ends_.empty())
            write_points();
        else
            write_lines();
    }

private:
    using Numbers = std::vector<std::string_view>;
    struct Field {
        std::string name;
        bool of_cells = false;
        std::size_t width = 1;
        Numbers numbers;
    };

    bool next() {
        if (kept_) {
            kept_ = false;
            return true;
        }
        while (const auto line = lines_.next()) {
            split_at_blanks(*line, words_);
            if (!words_.empty()) return true;
        }
        return false;
    }
    void wrong(const std::string& what) { problems_.add(lines_.number(), what); }

    /// The next `count` words, over as many lines as they take.
    Numbers numbers(long count) {
        Numbers all;
        if (count < 0 || count > most_numbers)
            wrong(fmt::format("a section must have at most {} numbers", most_numbers));
        while (problems_.empty() && static_cast<long>(all.size()) < count) {
            if (!next()) {
                wrong(fmt::format("{} more numbers must follow, got the file's end; truncated?",
                                  count - static_cast<long>(all.size())));
                return {};
            }
            all.insert(all.end(), words_.begin(), words_.end());
        }
        if (static_cast<long>(all.size()) > count && problems_.empty())
            wrong(fmt::format("a section must end at a line's end, got {} numbers more",
                              static_cast<long>(all.size()) - count));
        return all;
    }

    long count_at(std::size_t word) {
        const auto count = word < words_.size() ? to_whole_number(words_[word]) : std::nullopt;
        if (count && *count >= 0 && *count <= most_numbers) return *count;
        wrong(fmt::format("a section must say how many there are, up to {}, got {}", most_numbers,
                          word < words_.size() ? quoted(words_[word]) : "nothing"));
        return 0;
    }

    void section() {
        const std::string_view word = words_[0];
        if (word == "DATASET") {
            if (words_.size() != 2 || words_[1] != "POLYDATA") wrong("the data set must be POLYDATA");
        } else if (word == "POINTS") {
            points_ = numbers(3 * count_at(1));
        } else if (word == "LINES") {
            const long lines = count_at(1);
            if (count_at(2) != 3 * lines) return wrong("each line must join two points");
            ends_ = numbers(3 * lines);
        } else if (word == "POINT_DATA" || word == "CELL_DATA") {
            of_cells_ = word == "CELL_DATA";
            data_count_ = count_at(1);
        } else if ((word == "SCALARS" || word == "VECTORS" || word == "TENSORS") && words_.size() >= 2) {
            field(word == "SCALARS" ? 1 : word == "VECTORS" ? 3 : 9);
        } else {
            wrong(fmt::format(
                "must be one of POINTS, LINES, POINT_DATA, CELL_DATA, SCALARS, VECTORS, TENSORS, got {}",
                quoted(word)));
        }
    }

    void field(std::size_t width) {
        Field field{std::string(words_[1]), of_cells_, width, {}};
        if (width == 1 && next() && words_[0] != "LOOKUP_TABLE") kept_ = true;
        field.numbers = numbers(data_count_ * static_cast<long>(width));
        fields_.push_back(std::move(field));
    }

    void write_points() {
        write(points_.size() / 3, false, {"x", "y", "z"}, [&](std::size_t row, Numbers& cells) {
            cells.assign(points_.begin() + static_cast<long>(3 * row),
                         points_.begin() + static_cast<long>(3 * row) + 3);
        });
    }

    void write_lines() {
        const auto end = [&](std::size_t row, std::size_t which) {
            const auto point = to_whole_number(ends_[3 * row + which]);
            if (point && *point >= 0 && static_cast<std::size_t>(*point) < points_.size() / 3) return *point;
            problems_.add(fmt::format("line {} must join two of the {} points", row, points_.size() / 3));
            return 0L;
        };
        write(ends_.size() / 3, true, {"x1", "y1", "z1", "x2", "y2", "z2"},
              [&](std::size_t row, Numbers& cells) {
                  cells.clear();
                  for (const std::size_t which : {1u, 2u}) {
                      const auto first = points_.begin() + 3 * end(row, which);
                      cells.insert(cells.end(), first, first + 3);
                  }
              });
    }

    template <class Begin>
    void write(std::size_t rows, bool of_cells, std::vector<std::string> names, const Begin& begin) {
        for (const Field& field : fields_) {
            if (field.of_cells != of_cells) continue;
            if (field.numbers.size() != rows * field.width)
                return problems_.add(fmt::format("{} must have {} rows, as the points or lines, got {}",
                                                 field.name, rows, field.numbers.size() / field.width));
            for (std::size_t k = 0; k < field.width; ++k)
                names.push_back(field.width == 1 ? field.name
                                : field.width == 3
                                    ? fmt::format("{}_{}", field.name, "xyz"[k])
                                    : fmt::format("{}_{}{}", field.name, "xyz"[k / 3], "xyz"[k % 3]));
        }
        table_.name_columns(names, names.size());
        Numbers cells;
        for (std::size_t row = 0; row < rows && problems_.empty(); ++row) {
            begin(row, cells);
            for (const Field& field : fields_)
                if (field.of_cells == of_cells)
                    cells.insert(cells.end(), field.numbers.begin() + static_cast<long>(row * field.width),
                                 field.numbers.begin() + static_cast<long>((row + 1) * field.width));
            table_.add_row(cells);
        }
    }

    ForeignTable& table_;
    FileProblems& problems_;
    TextLines lines_;
    Numbers words_, points_, ends_;
    std::vector<Field> fields_;
    bool of_cells_ = false, kept_ = false;
    long data_count_ = 0;
};

}  // namespace

bool looks_like_vtk(std::string_view text) { return text.starts_with("# vtk DataFile"); }

void parse_vtk(ForeignTable& table, FileProblems& problems) {
    table.format = TableFormat::vtk;
    table.form = {' ', '.'};
    VtkParser(table, problems).parse();
}

}  // namespace mcdem
