// SHA-256 of a table in an HDF5 file: of its values, row by row as they lie in the file, then of its type and
// extent. README.md says how to work it out elsewhere.
#pragma once
#include <hdf5.h>

#include <cstddef>
#include <string>
#include <vector>

#include "core/sha256.h"

namespace mcdem::inline io::h5 {

class TableDigest {
public:
    /// None yet: of a table that is written. Else what the table is to have.
    explicit TableDigest(std::string expected = {}) : expected_(std::move(expected)) {}

    hsize_t rows() const { return rows_; }
    const std::string& expected() const { return expected_; }
    void add(const std::vector<std::byte>& values, hsize_t rows);
    /// Of all rows added; nothing may be added after.
    std::string hex(hid_t type, const std::vector<hsize_t>& extent);

private:
    Sha256 sum_;
    hsize_t rows_ = 0;
    std::string expected_;
};

/// `values`, `count` of them, from one type to another.
bool convert(std::vector<std::byte>& values, std::size_t count, hid_t from, hid_t to);

}  // namespace mcdem::io::h5
