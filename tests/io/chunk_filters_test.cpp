// Chunks that are filtered on all cores must have the bytes that the HDF5 library writes.

#include <gtest/gtest.h>
#include <hdf5.h>

#include <cstdint>
#include <random>

#include "core/atomic_file.h"
#include "io/hdf5.h"
#include "io/synthetic_run.h"

namespace mcdem::test {
namespace {

using Bytes = std::vector<unsigned char>;

/// The stored bytes of every chunk of a table.
std::vector<Bytes> stored_chunks(const std::filesystem::path& path, const char* table) {
    const h5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    const h5::Handle dataset(H5Dopen2(file, table, H5P_DEFAULT), H5Dclose);
    const h5::Handle space(H5Dget_space(dataset), H5Sclose);
    hsize_t count = 0;
    EXPECT_GE(H5Dget_num_chunks(dataset, space, &count), 0);
    std::vector<Bytes> chunks;
    for (hsize_t k = 0; k < count; ++k) {
        hsize_t offset[2] = {0, 0}, size = 0;
        unsigned left_out = 1;
        haddr_t address = 0;
        EXPECT_GE(H5Dget_chunk_info(dataset, space, k, offset, &left_out, &address, &size), 0);
        EXPECT_EQ(left_out, 0u) << "filters";
        chunks.emplace_back(size);
        std::uint32_t read_filters = 0;
        EXPECT_GE(H5Dread_chunk(dataset, H5P_DEFAULT, offset, &read_filters, chunks.back().data()), 0);
    }
    return chunks;
}

/// Writes a table in appends of these numbers of rows.
template <class Number>
void write_table(const std::filesystem::path& path, bool by_library, const std::vector<Number>& values,
                 const h5::Extent& row, const std::vector<hsize_t>& appends) {
    replace_file(path, [&](NewFile& out) {
        auto file = h5::File::create(out);
        const auto type = h5::number_type<Number>();
        auto table = file.create_rows("/table", type, row);
        if (by_library) table.filter_chunks(0);
        const Number* next = values.data();
        for (const hsize_t rows : appends) {
            table.append(type, next, rows);
            next += rows * h5::values_in(row);
        }
        ASSERT_EQ(next, values.data() + values.size());
        table.close();
        file.close();
        out.close();
    });
}

template <class Number>
void expect_bytes_of_the_library(const std::vector<Number>& values, const h5::Extent& row,
                                 const std::vector<hsize_t>& appends) {
    TestFolder folder;
    write_table(folder / "own.h5", false, values, row, appends);
    write_table(folder / "library.h5", true, values, row, appends);
    const auto own = stored_chunks(folder / "own.h5", "/table");
    EXPECT_GE(own.size(), 3u);
    EXPECT_EQ(own, stored_chunks(folder / "library.h5", "/table"));
}

TEST(chunk_filters, write_the_bytes_of_the_library) {
    std::mt19937 random(7);
    std::vector<float> noise(3 * 10000);
    for (float& value : noise) value = static_cast<float>(random()) / 3;
    expect_bytes_of_the_library(noise, {3}, {10000});
    expect_bytes_of_the_library(noise, {3}, {1, 2729, 1, 5000, 2269});  // chunks have 2730 rows
    std::vector<long> even(20000, 0), rising(20000);
    for (std::size_t k = 0; k < rising.size(); ++k) rising[k] = static_cast<long>(k * k);
    expect_bytes_of_the_library(even, {}, {20000});
    expect_bytes_of_the_library(rising, {}, {4096, 8192, 7712});
    std::vector<unsigned char> bytes(7 * 20000);
    for (auto& byte : bytes) byte = static_cast<unsigned char>(random() % 256);
    expect_bytes_of_the_library(bytes, {7}, {20000});  // an odd number of bytes in a chunk
}

}  // namespace
}  // namespace mcdem::test
