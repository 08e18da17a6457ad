// GCC warns about a file name that libfccp truncates on purpose for its own messages, which are not used
// here.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wstringop-truncation"
#endif
#include <fmt/format.h>
#include <libfccp/csv.h>

#include <set>

#include "scene/packing_fields.h"
#include "scene/read_packing.h"

namespace mcdem::inline scene {
namespace {

// Numbers are read as text, because the library does not round to the nearest double.
using PackingReader = io::CSVReader<7, io::trim_chars<' ', '\t'>, io::no_quote_escape<','>,
                                    io::throw_on_overflow, io::single_and_empty_line_comment<'#'>>;

/// The rows of one frame; a file without frames is a single frame.
class RowReader {
public:
    RowReader(PackingReader& reader, std::optional<long> wanted, FileProblems& problems)
        : reader_(reader),
          wanted_(wanted),
          has_frames_(reader.has_column("frame")),
          has_species_(reader.has_column("species") || reader.has_column("type")),
          problems_(problems) {}

    Packing read() {
        if (wanted_ && !has_frames_)
            problems_.add("must have a column frame where packing.frame is given, got none");
        while (!problems_.full() && next()) {
        }
        if (grains_.size() == 0 && problems_.empty() && !frames_.empty())
            problems_.add(fmt::format("the frame must be one of its {} frames, {} to {}, got {}",
                                      frames_.size(), *frames_.begin(), *frames_.rbegin(), *wanted_));
        return grains_.packing();
    }

private:
    bool next() {
        const char *x = nullptr, *y = nullptr, *z = nullptr, *diameter = nullptr, *frame = nullptr,
                   *species = nullptr, *type = nullptr;
        try {
            if (!reader_.read_row(x, y, z, diameter, frame, species, type)) return false;
            const long line = reader_.get_file_line();
            if (has_frames_ && !is_wanted(frame, line)) return true;
            const std::string_view name = species ? species : type ? type : "";
            grains_.add({x, y, z, diameter, name}, line);
            if (has_species_ && name.empty())
                problems_.add(line, "the species must be a name or a number, got none");
        } catch (const io::error::too_few_columns&) {
            problems_.add(reader_.get_file_line(),
                          "a line must have as many columns as the header, got fewer");
        } catch (const io::error::too_many_columns&) {
            problems_.add(reader_.get_file_line(),
                          "a line must have as many columns as the header, got more");
        }
        return true;
    }

    bool is_wanted(const char* word, long line) {
        const auto frame = to_whole_number(word);
        if (!frame)
            problems_.add(line, fmt::format("frame must be a whole number, got {}", quoted(word)));
        else
            frames_.insert(*frame);
        if (!wanted_) wanted_ = frame;  // the first
        return frame == wanted_;
    }

    PackingReader& reader_;
    std::optional<long> wanted_;
    const bool has_frames_, has_species_;
    FileProblems& problems_;
    std::set<long> frames_;
    GrainRows grains_{{.x = 0,
                       .y = 1,
                       .z = 2,
                       .size = 3,
                       .id = {},
                       .species = has_species_ ? std::optional<std::size_t>(4) : std::nullopt},
                      {"x", "y", "z", "diameter", "species"},
                      problems_};
};

}  // namespace

Packing read_csv_packing(std::istream& input, const std::string& source, std::optional<long> frame) {
    FileProblems problems(source);
    Packing packing;
    try {
        PackingReader reader(source, input);
        reader.read_header(io::ignore_extra_column | io::ignore_missing_column, "x_m", "y_m", "z_m",
                           "diameter_m", "frame", "species", "type");
        for (const char* column : {"x_m", "y_m", "z_m", "diameter_m"})
            if (!reader.has_column(column))
                problems.add(
                    1, fmt::format("the header must name x_m, y_m, z_m and diameter_m, got none named {}",
                                   column));
        if (problems.empty()) packing = RowReader(reader, frame, problems).read();
    } catch (const io::error::header_missing&) {
        problems.add("must begin with the header x_m,y_m,z_m,diameter_m, got an empty file");
    } catch (const io::error::duplicated_column_in_header& error) {
        problems.add(1, fmt::format("the header must name {} once, got it twice", error.column_name));
    } catch (const io::error::base& error) {
        problems.add(
            fmt::format("must be a CSV with the columns x_m,y_m,z_m,diameter_m, got: {}", error.what()));
    }
    problems.report();
    return packing;
}

}  // namespace mcdem::scene
