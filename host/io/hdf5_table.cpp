// Tables that are written: whole chunks are filtered here, on all cores.
#include <libdeflate.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <utility>

#include "core/in_parallel.h"
#include "io/hdf5.h"

namespace mcdem::inline io::h5 {
namespace {

constexpr hsize_t bytes_of_chunk(Storage storage) {
    return storage == Storage::plain ? 1024 * 1024 : 128 * 1024;
}
constexpr std::size_t filtered_at_once = 16 << 20;  ///< of chunks that are filtered together

/// First the first byte of every value, then the second one of every value, and so on; on a little-endian
/// processor, like OpenCL's devices here.
std::vector<std::byte> shuffled(std::span<const std::byte> chunk, std::size_t value_size) {
    std::vector<std::byte> bytes(chunk.size());
    const std::size_t count = chunk.size() / value_size;
    std::size_t byte = 0;
    for (; byte + 4 <= value_size; byte += 4) {
        std::byte *const first = &bytes[byte * count], *const second = first + count,
                         *const third = second + count, *const fourth = third + count;
        for (std::size_t i = 0; i < count; ++i) {
            std::uint32_t four = 0;
            std::memcpy(&four, &chunk[i * value_size + byte], sizeof four);
            first[i] = std::byte(four & 0xff);
            second[i] = std::byte(four >> 8 & 0xff);
            third[i] = std::byte(four >> 16 & 0xff);
            fourth[i] = std::byte(four >> 24);
        }
    }
    for (; byte < value_size; ++byte)
        for (std::size_t i = 0; i < count; ++i) bytes[byte * count + i] = chunk[i * value_size + byte];
    return bytes;
}

/// Fletcher's checksum of 16-bit words, the first byte of a word being the higher one.
std::uint32_t fletcher32(std::span<const std::byte> bytes) {
    constexpr std::size_t words_at_once = 360;  // their sums of sums fit into 32 bits
    const auto folded = [](std::uint32_t sum) { return (sum & 0xffff) + (sum >> 16); };
    std::uint32_t sum = 0, sum_of_sums = 0;
    for (std::size_t i = 0; i < bytes.size();) {
        const std::size_t end = std::min(bytes.size(), i + 2 * words_at_once);
        for (; i < end; i += 2) {
            const auto high = std::to_integer<std::uint32_t>(bytes[i]);
            const auto low = i + 1 < bytes.size() ? std::to_integer<std::uint32_t>(bytes[i + 1]) : 0;
            sum += high << 8 | low;
            sum_of_sums += sum;
        }
        sum = folded(sum);
        sum_of_sums = folded(sum_of_sums);
    }
    return folded(sum_of_sums) << 16 | folded(sum);
}

/// A zlib stream (RFC 1950), which every HDF5 library can read.
std::vector<std::byte> deflated(std::span<const std::byte> bytes) {
    constexpr int fastest = 1;
    using Compressor = std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)>;
    thread_local const Compressor compressor(libdeflate_alloc_compressor(fastest),
                                             libdeflate_free_compressor);
    if (!compressor) throw std::bad_alloc();
    std::vector<std::byte> stream(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()));
    stream.resize(
        libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), stream.data(), stream.size()));
    return stream;
}

/// The stored bytes of a chunk, as the library's filters make them.
std::vector<std::byte> filtered(std::span<const std::byte> chunk, std::size_t value_size, Storage storage) {
    auto bytes = storage == Storage::compressed ? deflated(shuffled(chunk, value_size))
                                                : std::vector<std::byte>(chunk.begin(), chunk.end());
    const std::uint32_t sum = fletcher32(bytes);
    for (int byte = 0; byte < 4; ++byte) bytes.push_back(std::byte(sum >> 8 * byte & 0xff));
    return bytes;
}

}  // namespace

NewTable::NewTable(File& file, std::string object, Handle type, Extent row, Storage storage)
    : file_(&file),
      object_(std::move(object)),
      type_(std::move(type)),
      row_(std::move(row)),
      storage_(storage),
      value_bytes_(H5Tget_size(type_)),
      row_bytes_(values_in(row_) * value_bytes_),
      chunk_rows_(std::max<hsize_t>(bytes_of_chunk(storage) / std::max<hsize_t>(row_bytes_, 1), 1)) {}

const std::byte* NewTable::append(const void* data, hsize_t rows) {
    const auto* from = static_cast<const std::byte*>(data);
    rows_ += rows;
    for (hsize_t some; rows > 0; rows -= some, from += some * row_bytes_) {
        if (rest_.size() == chunk_rows_ * row_bytes_) file_->add_chunk(*this, std::exchange(rest_, {}));
        some = std::min(rows, chunk_rows_ - rest_.size() / row_bytes_);
        rest_.reserve(std::min(chunk_rows_, rows_) * row_bytes_);
        rest_.insert(rest_.end(), from, from + some * row_bytes_);
    }
    return from;
}

void NewTable::finish() {
    if (rows_ > chunk_rows_) rest_.resize(chunk_rows_ * row_bytes_);
    if (rows_ > 0) file_->add_chunk(*this, std::exchange(rest_, {}));
}

void NewTable::close() {
    if (!rest_.empty()) finish();
    file_->write_chunks();
    if (rows_ == 0) create(1, true);
    table_->close();
}

/// With all rows in one chunk the table takes only their space.
void NewTable::create(hsize_t chunk_rows, bool grows) {
    Extent now{grows ? 0 : rows_}, most{grows ? H5S_UNLIMITED : rows_}, chunk{chunk_rows};
    for (auto* extent : {&now, &most, &chunk}) extent->insert(extent->end(), row_.begin(), row_.end());
    table_.emplace(file_->create_table(object_, type_, now, most, chunk, storage_));
}

void NewTable::write_chunk(std::span<const std::byte> stored, hsize_t rows) {
    const bool grows = rows_ > rows;
    if (!table_) create(rows, grows);
    if (grows) table_->set_rows(std::min(rows_, written_ + rows));
    table_->write_chunk(written_, stored);
    written_ += rows;
}

void File::add_chunk(NewTable& table, std::vector<std::byte> bytes) {
    chunk_bytes_ += bytes.size();
    chunks_.emplace_back(&table, std::move(bytes));
    if (chunk_bytes_ >= filtered_at_once) write_chunks();
}

void File::write_chunks() {
    std::vector<std::vector<std::byte>> stored(chunks_.size());
    in_parallel(chunks_.size(), [&](std::size_t k) {
        stored[k] = filtered(chunks_[k].second, chunks_[k].first->value_bytes_, chunks_[k].first->storage_);
    });
    for (std::size_t k = 0; k < stored.size(); ++k) {
        NewTable& table = *chunks_[k].first;
        table.write_chunk(stored[k], chunks_[k].second.size() / table.row_bytes_);
    }
    chunks_.clear();
    chunk_bytes_ = 0;
}

}  // namespace mcdem::io::h5
