// The filters of a compressed table, as the HDF5 library applies them to a chunk: shuffle, deflate,
// fletcher32.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace mcdem::inline io::h5 {

constexpr int deflate_level = 1;  // higher levels take five times as long for a few per cent

/// The stored bytes of a chunk whose values have `value_size` bytes each. May be called in several threads.
std::vector<std::byte> filtered(std::span<const std::byte> chunk, std::size_t value_size);

}  // namespace mcdem::io::h5
