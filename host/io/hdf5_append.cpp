// Appending rows to a table. Whole chunks are filtered here, on all cores; the library filters the others.
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <new>

#include "core/in_parallel.h"
#include "io/hdf5.h"

namespace mcdem::inline io::h5 {
namespace {

/// First the first byte of every value, then the second one of every value, and so on.
std::vector<std::byte> shuffled(std::span<const std::byte> chunk, std::size_t value_size) {
    std::vector<std::byte> bytes(chunk.size());
    const std::size_t count = chunk.size() / value_size;
    for (std::size_t byte = 0; byte < value_size; ++byte)
        for (std::size_t i = 0; i < count; ++i) bytes[byte * count + i] = chunk[i * value_size + byte];
    return bytes;
}

std::vector<std::byte> deflated(const std::vector<std::byte>& bytes) {
    uLongf size = compressBound(bytes.size());
    std::vector<std::byte> smaller(size);
    if (compress2(reinterpret_cast<Bytef*>(smaller.data()), &size,
                  reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), deflate_level) != Z_OK)
        throw std::bad_alloc();  // the only error for a destination of this size
    smaller.resize(size);
    return smaller;
}

/// Fletcher's checksum of 16-bit words, the first byte of a word being the higher one.
std::uint32_t fletcher32(const std::vector<std::byte>& bytes) {
    const auto folded = [](std::uint32_t sum) { return (sum & 0xffff) + (sum >> 16); };
    std::uint32_t sum = 0, sum_of_sums = 0;
    for (std::size_t i = 0; i < bytes.size(); i += 2) {
        const auto high = std::to_integer<std::uint32_t>(bytes[i]);
        const auto low = i + 1 < bytes.size() ? std::to_integer<std::uint32_t>(bytes[i + 1]) : 0;
        sum = folded(sum + (high << 8 | low));
        sum_of_sums = folded(sum_of_sums + sum);
    }
    return sum_of_sums << 16 | sum;
}

/// `values`, `count` of them, from one type to another.
bool convert(std::vector<std::byte>& values, std::size_t count, hid_t from, hid_t to) {
    if (count == 0 || H5Tequal(from, to) > 0) return true;
    const std::size_t from_size = H5Tget_size(from), to_size = H5Tget_size(to);
    values.resize(count * std::max(from_size, to_size));
    std::vector<std::byte> background(count * to_size);
    if (H5Tconvert(from, to, count, values.data(), background.data(), H5P_DEFAULT) < 0) return false;
    values.resize(count * to_size);
    return true;
}

}  // namespace

std::vector<std::byte> filtered(std::span<const std::byte> chunk, std::size_t value_size) {
    std::vector<std::byte> bytes = deflated(shuffled(chunk, value_size));
    const std::uint32_t sum = fletcher32(bytes);
    for (int byte = 0; byte < 4; ++byte) bytes.push_back(std::byte(sum >> 8 * byte & 0xff));
    return bytes;
}

void Dataset::append(hid_t memory_type, const void* data, hsize_t rows) {
    if (rows == 0) return;
    if (chunk_rows_ == 0) return write_rows(memory_type, data, rows);
    const Handle stored = type();
    const auto* begin = static_cast<const std::byte*>(data);
    const std::size_t count = values_in(rows), row_bytes = count / rows * H5Tget_size(stored);
    std::vector<std::byte> values(begin, begin + count * H5Tget_size(memory_type));
    if (!convert(values, count, memory_type, stored)) fail("has values of a type that cannot be converted");
    const hsize_t missing = (chunk_rows_ - this->rows() % chunk_rows_) % chunk_rows_;  // of the last chunk
    const hsize_t first = std::min(missing, rows), chunks = (rows - first) / chunk_rows_;
    const hsize_t last = first + chunks * chunk_rows_;
    write_rows(stored, values.data(), first);
    write_chunks(stored, values.data() + first * row_bytes, chunks);
    write_rows(stored, values.data() + last * row_bytes, rows - last);
}

/// Writes whole chunks after the last row, which must be the end of a chunk.
void Dataset::write_chunks(hid_t stored, const std::byte* data, hsize_t chunks) {
    if (chunks == 0) return;
    const std::size_t value_bytes = H5Tget_size(stored), chunk_bytes = values_in(chunk_rows_) * value_bytes;
    std::vector<std::vector<std::byte>> bytes(chunks);
    in_parallel(chunks, [&](std::size_t k) {
        bytes[k] = filtered(std::span(data + k * chunk_bytes, chunk_bytes), value_bytes);
    });
    Extent size = extent(), begin(size.size(), 0);
    begin.front() = size.front();
    size.front() += chunks * chunk_rows_;
    if (H5Dset_extent(id_, size.data()) < 0) fail("cannot grow");
    for (const auto& chunk : bytes) {
        if (H5Dwrite_chunk(id_, H5P_DEFAULT, 0, begin.data(), chunk.size(), chunk.data()) < 0 ||
            file_->error() != 0)
            fail("cannot be written");
        begin.front() += chunk_rows_;
    }
}

}  // namespace mcdem::io::h5
