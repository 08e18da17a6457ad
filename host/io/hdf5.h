// HDF5 files as this program uses them: rows appended to checksummed tables, small attributes. Every
// failing call becomes an error that names file and object: RunError in a file being written, InputError in
// one being read (a damaged or foreign file is something the user handed in).
#pragma once
#include <hdf5.h>

#include <array>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace mcdem::h5 {

/// An HDF5 identifier, closed with its owner.
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
    ~Handle() {
        if (id_ >= 0 && close_) close_(id_);
    }
    operator hid_t() const { return id_; }
    hid_t release() { return std::exchange(id_, -1); }

private:
    hid_t id_ = -1;
    Close close_ = nullptr;
};

enum class Access { read, write };
enum class Storage { plain, compressed };
using Extent = std::vector<hsize_t>;

/// The HDF5 type of a number in memory.
template <class Number>
Handle number_type();
template <>
Handle number_type<double>();
template <>
Handle number_type<float>();
template <>
Handle number_type<int>();
template <>
Handle number_type<long>();
template <>
Handle number_type<unsigned char>();
/// Text of exactly `length` bytes (at least 1), padded with zeros. Not of variable length: those live in a
/// part of the file that has no checksum.
Handle text_type(std::size_t length);

/// Throws the error described above, with the library's own innermost reason.
[[noreturn]] void fail(Access access, const std::string& where, const std::string& what);

/// A table of rows; the first dimension grows.
class Dataset {
public:
    Dataset(Handle id, Access access, std::string where)
        : id_(std::move(id)), access_(access), where_(std::move(where)) {}
    Extent extent() const;
    hsize_t rows() const { return extent().front(); }
    Handle type() const;
    const std::string& where() const { return where_; }

    /// Adds `rows` rows, converted from `memory_type`.
    void append(hid_t memory_type, const void* data, hsize_t rows);
    /// Reads rows first .. first + rows into `data`, converted to `memory_type`.
    void read(hid_t memory_type, void* data, hsize_t first, hsize_t rows) const;
    template <class Number>
    std::vector<Number> read_all() const;
    /// Throws unless the dataset has `rank` dimensions, of which those after the first are `row`.
    void expect_row(const Extent& row) const;

private:
    Handle select(hsize_t first, hsize_t rows) const;
    Handle id_;
    Access access_;
    std::string where_;
};

class File {
public:
    static File create(const std::filesystem::path& file);
    static File open(const std::filesystem::path& file);
    /// Writes everything out; errors such as a full disk show here at the latest.
    void close();

    void make_group(const std::string& object);
    bool exists(const std::string& object) const;
    /// Names of the objects in a group, sorted.
    std::vector<std::string> members(const std::string& group) const;

    /// A new table whose rows have the extent `row` (empty: one value a row). Groups on the way are made.
    /// With `rows_expected` a small table takes no more room than it needs.
    Dataset create_rows(const std::string& object, hid_t file_type, const Extent& row,
                        Storage storage = Storage::compressed, hsize_t rows_expected = 0);
    Dataset dataset(const std::string& object) const;
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
    File(Handle id, Access access, std::filesystem::path file)
        : id_(std::move(id)), access_(access), path_(std::move(file)) {}
    Handle object(const std::string& object) const;
    Handle attribute(const std::string& object, const std::string& name) const;
    void write_attribute(const std::string& object, const std::string& name, hid_t type, hid_t space,
                         const void* data);
    Handle id_;
    Access access_;
    std::filesystem::path path_;
};

template <class Number>
std::vector<Number> Dataset::read_all() const {
    hsize_t count = 1;
    for (hsize_t n : extent()) count *= n;
    std::vector<Number> values(count);
    read(number_type<Number>(), values.data(), 0, rows());
    return values;
}

template <class Number>
void File::write(const std::string& object, const std::vector<Number>& values, const Extent& row) {
    const Handle type = number_type<Number>();
    hsize_t width = 1;
    for (hsize_t n : row) width *= n;
    create_rows(object, type, row).append(type, values.data(), values.size() / width);
}

}  // namespace mcdem::h5
