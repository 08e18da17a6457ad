// The HDF5 library reads the chunks that the program compresses itself.

#include <gtest/gtest.h>
#include <hdf5.h>

#include <numeric>
#include <random>

#include "core/atomic_file.h"
#include "io/hdf5.h"
#include "io/synthetic_run.h"

namespace mcdem::test {
namespace {

/// Writes a table in appends of these numbers of rows, and returns the size of its chunks in the file.
template <class Number>
hsize_t write_table(const std::filesystem::path& path, const std::vector<Number>& values,
                    const h5::Extent& row, const std::vector<hsize_t>& appends, h5::Storage storage) {
    replace_file(path, [&](NewFile& out) {
        auto file = h5::File::create(out);
        h5::NewTable table(file, "/table", h5::number_type<Number>(), row, storage);
        const Number* next = values.data();
        for (const hsize_t rows : appends) {
            table.append(next, rows);
            next += rows * h5::values_in(row);
        }
        ASSERT_EQ(next, values.data() + values.size());
        table.close();
        file.close();
        out.close();
    });
    const h5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    return H5Dget_storage_size(h5::Handle(H5Dopen2(file, "/table", H5P_DEFAULT), H5Dclose));
}

/// The table must be read as it was written, whatever the appends, and the file have the same bytes. Returns
/// the compressed size over that of the values.
template <class Number>
double compressed(const std::vector<Number>& values, const h5::Extent& row,
                  const std::vector<hsize_t>& appends) {
    TestFolder folder;
    const hsize_t rows = values.size() / h5::values_in(row);
    hsize_t size = 0;
    for (const auto storage : {h5::Storage::plain, h5::Storage::compressed}) {
        size = write_table(folder / "one.h5", values, row, {rows}, storage);
        EXPECT_EQ(write_table(folder / "parts.h5", values, row, appends, storage), size);
        EXPECT_TRUE(bytes_of_file(folder / "one.h5") == bytes_of_file(folder / "parts.h5"));
        const auto file = h5::File::open(folder / "one.h5");
        const auto table = file.dataset("/table");
        table.expect_row(row);
        EXPECT_EQ(table.rows(), rows);
        EXPECT_TRUE(table.read_all<Number>() == values);
    }
    return static_cast<double>(size) / static_cast<double>(values.size() * sizeof(Number));
}

TEST(chunk_filters, the_library_reads_what_was_written) {
    std::mt19937 random(7);
    std::vector<float> noise(3 * 50000);
    for (float& value : noise) value = static_cast<float>(random()) / 3;
    EXPECT_LT(compressed(noise, {3}, {50000}), 0.9) << "the exponents are no noise";
    compressed(noise, {3}, {1, 10921, 1, 20000, 19077});  // compressed chunks have 10,922 rows
    compressed(noise, {3}, {10922, 10922, 28156});
    std::vector<long> even(200000, 0), rising(60000);
    EXPECT_LT(compressed(even, {}, {3, 199997}), 0.01);
    for (std::size_t k = 0; k < rising.size(); ++k) rising[k] = static_cast<long>(k * k);
    EXPECT_LT(compressed(rising, {}, {16384, 32768, 10848}), 0.7);
    std::vector<unsigned char> bytes(7 * 60000);
    for (auto& byte : bytes) byte = static_cast<unsigned char>(random() % 256);
    EXPECT_LT(compressed(bytes, {7}, {60000}), 1.2) << "the last chunk is whole";
    compressed(bytes, {7, 100}, {1, 599});
    compressed(std::vector<double>{}, {}, {0});
    compressed(std::vector<double>{1.5}, {}, {1});
}

}  // namespace
}  // namespace mcdem::test
