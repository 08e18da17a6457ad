#include "io/table_digest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/errors.h"
#include "io/hdf5.h"

namespace mcdem::h5 {
namespace {

/// As numpy names it: "f8", "S13", "(6,3)f8", "{frame:i4,time:f8}".
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

void TableDigest::add(const std::vector<std::byte>& values, hsize_t rows) {
    sum_.add(std::string_view(reinterpret_cast<const char*>(values.data()), values.size()));
    rows_ += rows;
}

std::string TableDigest::hex(hid_t type, const std::vector<hsize_t>& extent) {
    return sum_.add(fmt::format("{} {}", text_of(type), fmt::join(extent, "x"))).hex();
}

void convert(std::vector<std::byte>& values, std::size_t count, hid_t from, hid_t to) {
    if (count == 0 || H5Tequal(from, to) > 0) return;
    const std::size_t from_size = H5Tget_size(from), to_size = H5Tget_size(to);
    values.resize(count * std::max(from_size, to_size));
    std::vector<std::byte> background(count * to_size);
    if (H5Tconvert(from, to, count, values.data(), background.data(), H5P_DEFAULT) < 0)
        throw RunError("HDF5: values cannot be converted");
    values.resize(count * to_size);
}

}  // namespace mcdem::h5
