#include "io/chunk_filters.h"

#include <zlib.h>

#include <cstdint>
#include <new>

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

}  // namespace

std::vector<std::byte> filtered(std::span<const std::byte> chunk, std::size_t value_size) {
    std::vector<std::byte> bytes = deflated(shuffled(chunk, value_size));
    const std::uint32_t sum = fletcher32(bytes);
    for (int byte = 0; byte < 4; ++byte) bytes.push_back(std::byte(sum >> 8 * byte & 0xff));
    return bytes;
}

}  // namespace mcdem::io::h5
