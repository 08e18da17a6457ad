// Tables with what their columns mean, read into frames of SI values.
#pragma once
#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiment/experiment.h"
#include "experiment/import_mapping.h"

namespace mcdem {

/// A table of the mapping with its files. Copies share what the files hold.
struct ImportTable {
    MappedTable map;
    std::vector<std::shared_ptr<const ForeignTable>> parts;
};

/// One row of a table.
struct RowAt {
    const ForeignTable* part;
    std::size_t row;
    std::size_t part_index;  ///< among the table's files
    double key;              ///< of its frame: number, time [s where the column names a unit] or step
};

/// Reports what is wrong with a row, by file and line. Lines are counted only for problems that are told.
void add_problem(ExperimentProblems& problems, const RowAt& row, const std::string& what);
/// The same, told once for each topic and file.
void add_problem_once(ExperimentProblems& problems, const std::string& topic, const RowAt& row,
                      const std::string& what);

inline constexpr std::size_t all_rows = std::numeric_limits<std::size_t>::max();

/// What tells the rows' frames: the files' places in the list, the last numbers in their names, a dump's
/// steps, a column.
enum class KeyedBy { place, file, step, column };

/// A number of the mapping, 0 where it has none.
double number_entry(const MappedTable& map, std::string_view key);

/// A whole number of the mapping, 0 where it has none; anything else is a problem.
long whole_entry(const MappedTable& map, std::string_view key, ExperimentProblems& problems);

/// The rows in the order of the files, and what their columns hold.
class Rows {
public:
    /// Columns that are not there are problems. Reads `most` rows of each file.
    Rows(const ImportTable& table, ExperimentProblems& problems, std::size_t most = all_rows);
    const std::vector<RowAt>& all() const { return rows_; }
    KeyedBy keyed_by() const { return keyed_by_; }
    /// Frames have numbers, times or steps of their own.
    bool keyed() const { return keyed_by_ == KeyedBy::step || keyed_by_ == KeyedBy::column; }
    /// The entry's value in that row: of several columns their sum; anything else than numbers is a problem.
    std::optional<double> number(const RowAt& row, std::string_view key) const;
    /// The same of one column, without a problem.
    std::optional<double> number_if_any(const RowAt& row, std::string_view key) const {
        return row.part->number(row.row, column_of(row, key));
    }
    std::optional<long> whole_number(const RowAt& row, std::string_view key) const;
    std::string_view text(const RowAt& row, std::string_view key) const;
    bool has_column(std::string_view key) const { return columns_.contains(key); }
    void problem(const RowAt& row, const std::string& what) const { add_problem(problems_, row, what); }
    void problem_once(const std::string& topic, const RowAt& row, const std::string& what) const {
        add_problem_once(problems_, topic, row, what);
    }

private:
    void find_columns(const ImportTable& table);
    std::size_t column_of(const RowAt& row, std::string_view key) const;
    ExperimentProblems& problems_;
    struct Column {
        double sign;
        std::size_t index;
    };
    std::map<std::string, std::vector<std::vector<Column>>, std::less<>> columns_;  ///< by key and part
    std::vector<const ForeignTable*> parts_;
    std::vector<RowAt> rows_;
    KeyedBy keyed_by_ = KeyedBy::place;
};

/// Frames by their number, time or step. Times may differ by a thousandth of the shortest interval.
class FrameIndex {
public:
    FrameIndex() = default;
    explicit FrameIndex(const std::vector<double>& keys);
    int find(double key) const;  ///< -1: none

private:
    std::vector<std::pair<double, int>> sorted_;
    double tolerance_ = 0;
};

/// The plate's rows: scans without grains, and the frame's number, time or step of each.
struct PlateRows {
    std::vector<Scan> scans;
    std::vector<double> keys;
    FrameIndex index;
    bool keyed = false;
};
/// Heights need `plate_start` [m] where the table states displacements; not-a-number where it is not known.
PlateRows import_plate(const ImportTable& table, double plate_start, ExperimentProblems& problems);

/// Grains by frame, each frame whole, in the order of their ids.
struct GrainFrames {
    std::vector<double> keys;
    FrameIndex index;
    std::vector<std::vector<Vec3>> position;  ///< [m]
    std::vector<double> diameter;             ///< of the first frame [m]
    std::map<long, int> number_of;            ///< from the table's number of a grain
    std::vector<RowAt> first_row;             ///< of each frame, for messages
    Vec3 origin = Vec3::Zero();               ///< of the box, in the tables' axes once they are turned [m]
    Vec3 sign = Vec3::Ones();                 ///< -1 where a table's axis counts the other way
    std::vector<int> row;                     ///< of the plate, of each frame; -1: none; empty: not known
    FrameIndex plate;                         ///< the plate's rows
    std::size_t plate_rows = 0;
    /// The plate's row of another table's frame, its `place`-th, that has this key; `by` as in frames_by. -1:
    /// none.
    int plate_row_of(std::string_view by, double key, std::size_t place) const;
    /// The same of the grains' frames. Where the plate's rows are not known, frames in order are the grains'
    /// own.
    int frame_of(std::string_view by, double key, std::size_t place) const;
    double top(std::size_t frame) const;  ///< of the highest grain [m]
};
/// Finds each frame's row of the plate, by its key or in order.
void place_frames(GrainFrames& grains, bool by_order, const PlateRows& plate);
GrainFrames import_grains(const std::vector<const ImportTable*>& tables, ExperimentProblems& problems);

/// Contacts by frame, numbered as `grains`. Points that were not measured are not-a-number.
struct ContactFrames {
    struct One {
        Contact contact;
        RowAt row;
    };
    std::vector<double> keys;
    FrameIndex index;
    std::vector<std::vector<One>> contacts;
};
ContactFrames import_contacts(const ImportTable& table, const GrainFrames& grains,
                              ExperimentProblems& problems, std::size_t most = all_rows);

}  // namespace mcdem
