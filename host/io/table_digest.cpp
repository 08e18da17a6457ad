// Digests of tables.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/errors.h"
#include "io/hdf5.h"

namespace mcdem::inline io::h5 {
namespace {

constexpr std::size_t block_bytes = 1 << 20;  ///< bytes per block of the digest

/// Names of NumPy: "f8", "S13", "(6,3)f8", "{frame:i4,time:f8}".
std::string text_of(hid_t type) {
    const std::size_t size = H5Tget_size(type);
    switch (H5Tget_class(type)) {
        case H5T_INTEGER:
            return fmt::format("{}{}", H5Tget_sign(type) == H5T_SGN_NONE ? "u" : "i", size);
        case H5T_ENUM:
            return fmt::format("i{}", size);
        case H5T_FLOAT:
            return fmt::format("f{}", size);
        case H5T_STRING:
            return fmt::format("S{}", size);
        case H5T_ARRAY: {
            Extent extent(static_cast<std::size_t>(std::max(H5Tget_array_ndims(type), 0)));
            H5Tget_array_dims2(type, extent.data());
            return fmt::format("({}){}", fmt::join(extent, ","),
                               text_of(Handle(H5Tget_super(type), H5Tclose)));
        }
        case H5T_COMPOUND: {
            std::string text;
            for (unsigned i = 0; i < static_cast<unsigned>(H5Tget_nmembers(type)); ++i) {
                char* field = H5Tget_member_name(type, i);
                text += fmt::format("{}{}:{}", i ? "," : "", field ? field : "",
                                    text_of(Handle(H5Tget_member_type(type, i), H5Tclose)));
                H5free_memory(field);
            }
            return fmt::format("{{{}}}", text);
        }
        default:
            return fmt::format("?{}", size);
    }
}

}  // namespace

void TableDigest::add(const std::vector<std::byte>& values, hsize_t new_rows) {
    sum.add(std::string_view(reinterpret_cast<const char*>(values.data()), values.size()));
    rows += new_rows;
}

std::string TableDigest::hex(hid_t type, const std::vector<hsize_t>& extent) {
    return sum.add(fmt::format("{} {}", text_of(type), fmt::join(extent, "x"))).hex();
}

bool convert(std::vector<std::byte>& values, std::size_t count, hid_t from, hid_t to) {
    if (count == 0 || H5Tequal(from, to) > 0) return true;
    const std::size_t from_size = H5Tget_size(from), to_size = H5Tget_size(to);
    values.resize(count * std::max(from_size, to_size));
    std::vector<std::byte> background(count * to_size);
    if (H5Tconvert(from, to, count, values.data(), background.data(), H5P_DEFAULT) < 0) return false;
    values.resize(count * to_size);
    return true;
}

/// Block by block, to avoid a second copy in memory. `data`: destination of the rows, or null.
void Dataset::read_checked(hid_t memory_type, std::byte* data, hsize_t rows) const {
    const Handle stored = type();
    const std::size_t in_row = values_in(1), row_bytes = in_row * H5Tget_size(stored);
    const hsize_t in_block = std::max<hsize_t>(1, block_bytes / std::max<std::size_t>(1, row_bytes));
    for (hsize_t done = 0; done < rows;) {
        const hsize_t some = std::min(in_block, rows - done);
        std::vector<std::byte> values(some * row_bytes);
        read_rows(stored, values.data(), digest_->rows, some);
        digest_->add(values, some);
        done += some;
        if (!data) continue;
        if (!convert(values, some * in_row, stored, memory_type))
            fail("has values of another type than expected");
        std::ranges::copy(values, data);
        data += values.size();
    }
    if (digest_->rows == this->rows()) check_digest();
}

void Dataset::check_digest() const {
    const std::unique_ptr<TableDigest> digest = std::move(digest_);
    if (digest->hex(type(), extent()) != digest->expected)
        throw InputError(
            where_ +
            ": does not have the digest that it was written with; the file is damaged: restore it "
            "from a copy or run again");
}

void Dataset::expect_digest(const std::string& digest) {
    keep_digest();
    digest_->expected = digest;
}

std::string Dataset::digest() const { return digest_->hex(type(), extent()); }

void Dataset::expect_whole() const {
    if (digest_) read(type(), nullptr, 0, rows());
}

}  // namespace mcdem::io::h5
