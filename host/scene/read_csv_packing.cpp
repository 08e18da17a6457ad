// GCC warns of a file name that libfccp cuts on purpose for its own messages, which are not used here.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wstringop-truncation"
#endif
#include <fmt/format.h>
#include <libfccp/csv.h>

#include "scene/packing_fields.h"
#include "scene/read_packing.h"

namespace mcdem {
namespace {

// Words are read as text: the library's own numbers are not rounded to the nearest double.
using Reader = io::CSVReader<4, io::trim_chars<' ', '\t'>, io::no_quote_escape<','>, io::throw_on_overflow,
                             io::single_and_empty_line_comment<'#'>>;

void read_rows(Reader& reader, Packing& packing, FileProblems& problems) {
    const char *x = nullptr, *y = nullptr, *z = nullptr, *diameter = nullptr;
    while (!problems.full()) {
        try {
            if (!reader.read_row(x, y, z, diameter)) return;
            add_grain(packing, x, y, z, diameter, reader.get_file_line(), problems);
        } catch (const io::error::too_few_columns&) {
            problems.add(reader.get_file_line(), "a line must have as many columns as the header, got fewer");
        } catch (const io::error::too_many_columns&) {
            problems.add(reader.get_file_line(), "a line must have as many columns as the header, got more");
        }
        if (packing.size() > static_cast<std::size_t>(largest_packing)) {
            problems.add(fmt::format("a packing must have at most {} grains, got more", largest_packing));
            return;
        }
    }
}

}  // namespace

Packing read_csv_packing(std::istream& input, const std::string& source) {
    FileProblems problems(source);
    Packing packing;
    try {
        Reader reader(source, input);
        reader.read_header(io::ignore_extra_column, "x_m", "y_m", "z_m", "diameter_m");
        read_rows(reader, packing, problems);
        if (packing.size() == 0 && problems.empty())
            problems.add("a packing must have at least 1 grain, got none");
    } catch (const io::error::header_missing&) {
        problems.add("must begin with the header x_m,y_m,z_m,diameter_m, got an empty file");
    } catch (const io::error::missing_column_in_header& error) {
        problems.add(1, fmt::format("the header must name x_m, y_m, z_m and diameter_m, got none named {}",
                                    error.column_name));
    } catch (const io::error::duplicated_column_in_header& error) {
        problems.add(1, fmt::format("the header must name {} once, got it twice", error.column_name));
    } catch (const io::error::base& error) {
        problems.add(
            fmt::format("must be a CSV with the columns x_m,y_m,z_m,diameter_m, got: {}", error.what()));
    }
    problems.report();
    return packing;
}

}  // namespace mcdem
