// HDF5 files: tables with checksums to which rows are appended, and small attributes. Every failing call
// becomes an error with the names of file and object: RunError for a file that is being written and for
// failures of the system, InputError for invalid content of a file that is being read (damaged or foreign).
#pragma once
#include <hdf5.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/atomic_file.h"
#include "io/hdf5_driver.h"

namespace mcdem::inline io::h5 {

/// An HDF5 identifier that is closed by its owner.
class Handle {
public:
    using Close = herr_t (*)(hid_t);
    Handle() = default;
    Handle(hid_t id, Close close) : id_(id), close_(close) {}
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(id_, other.id_);
        std::swap(close_, other.close_);
        return *this;
    }
    ~Handle() { close(); }
    operator hid_t() const { return id_; }
    /// Returns the result of the library: cached data may be written only now.
    herr_t close() {
        const hid_t id = std::exchange(id_, -1);
        return id >= 0 && close_ ? close_(id) : 0;
    }

private:
    hid_t id_ = -1;
    Close close_ = nullptr;
};

enum class Storage { plain, compressed };
using Extent = std::vector<hsize_t>;

/// The HDF5 type of a number in memory.
template <class Number>
Handle number_type() {
    if constexpr (std::is_same_v<Number, double>) return {H5Tcopy(H5T_NATIVE_DOUBLE), H5Tclose};
    if constexpr (std::is_same_v<Number, float>) return {H5Tcopy(H5T_NATIVE_FLOAT), H5Tclose};
    if constexpr (std::is_same_v<Number, int>) return {H5Tcopy(H5T_NATIVE_INT), H5Tclose};
    if constexpr (std::is_same_v<Number, long>) return {H5Tcopy(H5T_NATIVE_LONG), H5Tclose};
    if constexpr (std::is_same_v<Number, unsigned char>) return {H5Tcopy(H5T_NATIVE_UCHAR), H5Tclose};
}
/// Number of values in a table, or in one of its rows.
inline hsize_t values_in(const Extent& extent) {
    hsize_t count = 1;
    for (const hsize_t n : extent) count *= n;
    return count;
}
/// Text of exactly `length` bytes (at least 1), padded with zeros. Variable-length text would be stored in a
/// part of the file without checksum.
Handle text_type(std::size_t length);

/// Throws the error described above with its reason: that of the system, otherwise the innermost one of the
/// library.
[[noreturn]] void fail(const FileBelow& file, const std::string& where, const std::string& what);

/// A table of rows. Must not outlive its file.
class Dataset {
public:
    Dataset(Handle id, const FileBelow& file, std::string where)
        : id_(std::move(id)), file_(&file), where_(std::move(where)) {}
    Extent extent() const;
    hsize_t rows() const { return extent().front(); }
    Handle type() const;
    const std::string& where() const { return where_; }

    /// Reads rows first .. first + rows into `data`, converted to `memory_type`.
    void read(hid_t memory_type, void* data, hsize_t first, hsize_t rows) const;
    template <class Number>
    std::vector<Number> read_all() const;
    /// Throws unless the dataset has `rank` dimensions and those after the first are `row`.
    void expect_row(const Extent& row) const;
    /// Reads all rows. Throws InputError if a checksum is wrong.
    void expect_whole() const;
    // For a table that is written:
    void set_rows(hsize_t rows);
    /// Writes the chunk that begins with row `first`, as it is stored.
    void write_chunk(hsize_t first, std::span<const std::byte> stored);
    /// Returns only if all of it is in the file, otherwise throws.
    void close();
    /// Throws like `h5::fail`.
    [[noreturn]] void fail(const std::string& what) const { h5::fail(*file_, where_, what); }

private:
    Handle select(hsize_t first, hsize_t rows) const;
    /// Number of values in `rows` rows.
    std::size_t values_in(hsize_t rows) const;
    Handle id_;
    const FileBelow* file_;
    std::string where_;
};

class File {
public:
    /// Writes into the new file, whose owner closes it afterwards.
    static File create(NewFile& out);
    static File open(const std::filesystem::path& file);
    File(File&&) = default;
    ~File();
    /// Flushes everything; errors such as a full disk are detected here at the latest.
    void close();

    void make_group(const std::string& object);
    bool exists(const std::string& object) const;
    /// Names of the objects in a group, sorted.
    std::vector<std::string> members(const std::string& group) const;

    /// Creates a table, and its parent groups.
    Dataset create_table(const std::string& object, hid_t type, const Extent& now, const Extent& most,
                         const Extent& chunk, Storage storage);
    /// Takes a whole chunk of rows of a table, which is written later: chunks are filtered together, on all
    /// cores. Filters take most of the time of writing, and the library would use one core.
    void add_chunk(class NewTable& table, std::vector<std::byte> bytes);
    void write_chunks();
    Dataset dataset(const std::string& object) const;
    /// Names of all tables of the file.
    std::vector<std::string> tables() const;
    /// Reads all tables. Throws InputError if a checksum is wrong. `before_each` is called before each table;
    /// what it throws is passed on.
    void expect_whole(const std::function<void()>& before_each) const;
    template <class Number>
    void write(const std::string& object, const std::vector<Number>& values, const Extent& row = {});
    void write_texts(const std::string& object, const std::vector<std::string>& texts,
                     const Extent& row = {});
    std::vector<std::string> read_texts(const std::string& object) const;

    void set_attribute(const std::string& object, const std::string& name, std::string_view text);
    void set_attribute(const std::string& object, const std::string& name, const std::vector<double>& values);
    void set_attribute(const std::string& object, const std::string& name, const std::vector<long>& values);
    bool has_attribute(const std::string& object, const std::string& name) const;
    std::string text_attribute(const std::string& object, const std::string& name) const;
    std::vector<double> numbers_attribute(const std::string& object, const std::string& name) const;
    long integer_attribute(const std::string& object, const std::string& name) const;

    const std::filesystem::path& path() const { return path_; }
    std::string where(const std::string& object) const { return path_.string() + ": " + object; }

private:
    File(std::unique_ptr<FileBelow> below, std::filesystem::path path)
        : below_(std::move(below)), path_(std::move(path)) {}
    [[noreturn]] void fail(const std::string& where, const std::string& what) const {
        h5::fail(*below_, where, what);
    }
    /// Result of a query of the library. Throws RunError if the query failed because the system refused to
    /// read.
    int answered(int answer, const std::string& object) const;
    /// Refuses links to other objects, inside or outside the file.
    void expect_inside(const std::string& object) const;
    Handle object(const std::string& object) const;
    /// The library may write an object only when it is closed.
    void close_written(Handle handle, const std::string& object);
    Handle attribute(const std::string& object, const std::string& name) const;
    void write_attribute(const std::string& object, const std::string& name, hid_t type, hid_t space,
                         const void* data);
    std::unique_ptr<FileBelow> below_;  ///< used by id_ until it is closed
    std::filesystem::path path_;
    Handle id_;
    std::set<std::string> groups_;                                            ///< that were made
    std::vector<std::pair<class NewTable*, std::vector<std::byte>>> chunks_;  ///< not written yet
    std::size_t chunk_bytes_ = 0;                                             ///< of these
};

template <class Number>
std::vector<Number> Dataset::read_all() const {
    std::vector<Number> values(h5::values_in(extent()));
    read(number_type<Number>(), values.data(), 0, rows());
    return values;
}

/// A table of a file to which rows are appended, and which is created when its first chunk is complete or all
/// rows are known. Chunks of all tables are written in the order in which they become complete. Must stay
/// where it is after the first call of append().
class NewTable {
public:
    /// Rows of the extent `row` (empty: one value per row), with values of `type`.
    NewTable(File& file, std::string object, Handle type, Extent row, Storage storage = Storage::compressed);
    /// Returns the end of the data.
    const std::byte* append(const void* data, hsize_t rows);
    /// Call after the last row, once.
    void finish();
    /// Returns only if all rows are in the file, otherwise throws. Calls finish() if necessary.
    void close();

private:
    friend class File;
    void create(hsize_t chunk_rows, bool grows);
    void write_chunk(std::span<const std::byte> stored, hsize_t rows);
    File* file_;
    std::string object_;
    Handle type_;
    Extent row_;
    Storage storage_;
    std::size_t value_bytes_;
    hsize_t row_bytes_, chunk_rows_;
    hsize_t rows_ = 0, written_ = 0;
    std::vector<std::byte> rest_;  ///< the last rows, at most a chunk
    std::optional<Dataset> table_;
};

template <class Number>
void File::write(const std::string& object, const std::vector<Number>& values, const Extent& row) {
    NewTable table(*this, object, number_type<Number>(), row);
    table.append(values.data(), values.size() / values_in(row));
    table.close();
}

}  // namespace mcdem::io::h5
