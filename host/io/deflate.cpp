#include "io/deflate.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace mcdem::inline io {
namespace {

// RFC 1951: literals 0 to 255, end of a block, and lengths of matches.
constexpr int end_of_block = 256, symbols = 286, longest_code = 15;
constexpr std::size_t length_symbols = 254;  ///< symbol of a match of length 0, if there were one
constexpr std::size_t shortest_match = 3, longest_match = 258, longest_simple = 10;  ///< without extra bits
constexpr std::size_t longest_stored = 65535, sample_size = 1024, shortest_block = 2048;

using Lengths = std::array<std::uint8_t, symbols>;
using Counts = std::array<std::uint32_t, symbols>;

struct Code {
    std::uint16_t bits = 0;  ///< the first one lowest
    std::uint8_t length = 0;
};

class BitWriter {
public:
    explicit BitWriter(std::size_t most) : bytes_(most + sizeof bits_) {}
    void put(std::uint32_t bits, int count) {
        bits_ |= std::uint64_t(bits) << count_;
        count_ += count;
        std::memcpy(bytes_.data() + size_, &bits_, sizeof bits_);
        size_ += static_cast<std::size_t>(count_ / 8);
        bits_ >>= count_ / 8 * 8;
        count_ %= 8;
    }
    void put(Code code) { put(code.bits, code.length); }
    void fill_byte() { put(0, (8 - count_) % 8); }
    /// At the end of a byte.
    void put(std::span<const std::byte> bytes) {
        std::memcpy(bytes_.data() + size_, bytes.data(), bytes.size());
        size_ += bytes.size();
    }
    std::vector<std::byte> take() {
        bytes_.resize(size_);
        return std::move(bytes_);
    }

private:
    std::vector<std::byte> bytes_;
    std::size_t size_ = 0;
    std::uint64_t bits_ = 0;
    int count_ = 0;  ///< of bits that are no whole byte yet
};

/// Whether the first bytes of a plane are almost as evenly distributed as random ones, for which the sum of
/// squares of their counts is n^2/256 + n. Coding a plane at the limit, three times n^2/256, would save a
/// tenth.
bool is_noise(std::span<const std::byte> plane) {
    const std::size_t size = std::min(plane.size(), sample_size);
    std::array<std::uint32_t, 256> counts{};
    for (const std::byte byte : plane.first(size)) ++counts[std::to_integer<std::size_t>(byte)];
    double squares = 0;
    for (const double count : counts) squares += count * count;
    const auto n = static_cast<double>(size);
    return squares < 3 * n * n / 256 + n;
}

/// Symbols of some bytes, how often they occur, and the lengths of their codes.
struct Coded {
    std::vector<std::uint16_t> found;
    std::size_t size = 0;  ///< of `found` in use
    Counts counts{};
    Lengths lengths{};
};

/// Literals and matches with the byte before. Several short matches stand for one whose code has extra bits.
void find_symbols(std::span<const std::byte> bytes, Coded& coded) {
    coded.found.resize(std::max(coded.found.size(), bytes.size() + 1));
    coded.counts.fill(0);
    std::uint16_t* next = coded.found.data();
    const auto add = [&](std::size_t symbol) {
        *next++ = static_cast<std::uint16_t>(symbol);
        ++coded.counts[symbol];
    };
    for (std::size_t i = 0; i < bytes.size();) {
        const std::byte byte = bytes[i++];
        add(std::to_integer<std::size_t>(byte));
        if (i == bytes.size() || bytes[i] != byte) continue;
        std::size_t same = 1;
        while (i + same < bytes.size() && bytes[i + same] == byte) ++same;
        for (; same >= longest_match; same -= longest_match, i += longest_match) add(symbols - 1);
        for (; same >= shortest_match; same -= std::min(same, longest_simple)) {
            add(length_symbols + std::min(same, longest_simple));
            i += std::min(same, longest_simple);
        }
    }
    add(end_of_block);
    coded.size = static_cast<std::size_t>(next - coded.found.data());
}

/// Huffman's codes; at least two symbols must occur. With codes that would be too long, rare symbols are
/// treated as less rare.
void find_lengths(Coded& coded) {
    std::array<std::uint64_t, symbols> leaves;     // counts and symbols, sorted
    std::array<std::uint64_t, 2 * symbols> total;  // of leaves, then of their parents
    std::array<int, 2 * symbols> parent{}, depth{};
    for (int halvings = 0;; ++halvings) {
        int count = 0;
        for (std::uint64_t s = 0; s < symbols; ++s)
            if (coded.counts[s] > 0) leaves[count++] = ((coded.counts[s] >> halvings | 1) << 9) + s;
        std::sort(leaves.begin(), leaves.begin() + count);
        for (int k = 0; k < count; ++k) total[k] = leaves[k] >> 9;
        const int root = 2 * count - 2;
        for (int made = count, leaf = 0, inner = count; made <= root; ++made) {
            total[made] = 0;
            for (int child = 0; child < 2; ++child) {
                const bool takes_leaf = leaf < count && (inner >= made || total[leaf] <= total[inner]);
                const int taken = takes_leaf ? leaf++ : inner++;
                total[made] += total[taken];
                parent[taken] = made;
            }
        }
        depth[root] = 0;
        for (int k = root - 1; k >= 0; --k) depth[k] = depth[parent[k]] + 1;
        if (*std::max_element(depth.begin(), depth.begin() + count) > longest_code) continue;
        coded.lengths.fill(0);
        for (int k = 0; k < count; ++k) coded.lengths[leaves[k] & 511] = static_cast<std::uint8_t>(depth[k]);
        return;
    }
}

template <std::size_t count>
std::array<Code, count> codes_of(const std::array<std::uint8_t, count>& lengths) {
    std::array<std::uint32_t, longest_code + 2> next{};  // by length
    for (const std::uint8_t length : lengths) next[length + 1u] += length > 0;
    for (std::size_t length = 1; length < next.size(); ++length) next[length] += next[length - 1];
    // next[l]: number of shorter codes; the first code of length l continues theirs.
    std::uint32_t first = 0, shorter = 0;
    for (std::size_t length = 1; length <= longest_code; ++length) {
        first = (first + next[length] - shorter) * 2;
        shorter = next[length];
        next[length] = first;
    }
    std::array<Code, count> codes{};
    for (std::size_t s = 0; s < count; ++s) {
        if (lengths[s] == 0) continue;
        const std::uint32_t code = next[lengths[s]]++;
        for (int bit = 0; bit < lengths[s]; ++bit)
            codes[s].bits |= static_cast<std::uint16_t>((code >> bit & 1) << (lengths[s] - 1 - bit));
        codes[s].length = lengths[s];
    }
    return codes;
}

/// A code of 19 symbols for the lengths themselves: 4 bits each, 5 for length 15 and for symbol 18, a row of
/// zeros.
constexpr int zeros = 18, fewest_zeros = 11, most_zeros = 138;
constexpr std::array<std::uint8_t, 19> lengths_of_length_codes{4, 4, 4, 4, 4, 4, 4, 4, 4, 4,
                                                               4, 4, 4, 4, 4, 5, 0, 0, 5};
constexpr std::array<int, 19> order_of_length_codes{16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                    11, 4,  12, 3, 13, 2, 14, 1, 15};

/// Header of a block with its own codes.
void put_lengths(const Lengths& lengths, BitWriter& out) {
    static const auto codes = codes_of(lengths_of_length_codes);
    out.put(0b100, 3);  // not the last block; Huffman codes of its own
    out.put(symbols - 257, 5);
    out.put(0, 5);  // one distance
    out.put(19 - 4, 4);
    for (const int symbol : order_of_length_codes) out.put(lengths_of_length_codes[symbol], 3);
    for (int s = 0; s < symbols;) {
        int none = 0;
        while (s + none < symbols && none < most_zeros && lengths[s + none] == 0) ++none;
        if (none >= fewest_zeros) {
            out.put(codes[zeros]);
            out.put(static_cast<std::uint32_t>(none - fewest_zeros), 7);
            s += none;
        } else {
            out.put(codes[lengths[s++]]);
        }
    }
    out.put(codes[1]);  // the distance 1 has a code of 1 bit, zero
}

/// Returns false if the bytes would hardly become smaller.
bool find_code(std::span<const std::byte> bytes, Coded& coded) {
    constexpr std::size_t header_bits = 8 * 150;
    if (bytes.size() <= header_bits / 8 || is_noise(bytes)) return false;
    find_symbols(bytes, coded);
    find_lengths(coded);
    std::size_t bits = header_bits;
    for (int s = 0; s < symbols; ++s)
        bits += coded.counts[s] * (coded.lengths[s] + std::size_t{s > end_of_block});
    return bits < 8 * bytes.size();
}

void put_coded(const Coded& coded, BitWriter& out) {
    put_lengths(coded.lengths, out);
    const auto codes = codes_of(coded.lengths);
    for (const std::uint16_t symbol : std::span(coded.found).first(coded.size))  // after a match its distance
        out.put(codes[symbol].bits, codes[symbol].length + (symbol > end_of_block));
}

void put_stored(std::span<const std::byte> bytes, BitWriter& out) {
    while (!bytes.empty()) {
        const auto some = bytes.first(std::min(bytes.size(), longest_stored));
        const auto size = static_cast<std::uint32_t>(some.size());
        out.put(0, 3);  // not the last block; stored
        out.fill_byte();
        out.put(size | (~size & 0xffff) << 16, 32);
        out.put(some);
        bytes = bytes.subspan(some.size());
    }
}

}  // namespace

std::vector<std::byte> deflated(std::span<const std::byte> planes, std::size_t plane_size) {
    const std::size_t block = plane_size * ((shortest_block + plane_size - 1) / plane_size);
    const std::size_t blocks = 2 * planes.size() / block + planes.size() / longest_stored + 2;
    BitWriter out(planes.size() + 6 * blocks + 16);
    out.put(0x0178, 16);  // zlib's header
    Coded coded;
    std::size_t written = 0;
    const auto add = [&](std::size_t first, std::size_t end) {
        if (!find_code(planes.subspan(first, end - first), coded)) return;
        put_stored(planes.subspan(written, first - written), out);
        put_coded(coded, out);
        written = end;
    };
    for (std::size_t first = 0; first < planes.size(); first += block) {
        const std::size_t end = std::min(first + block, planes.size());
        std::size_t filled = end;  // the end of the last chunk of a table is filled with zeros
        while (filled > first && planes[filled - 1] == std::byte{0}) --filled;
        add(first, filled);
        add(filled, end);
    }
    put_stored(planes.subspan(written), out);
    out.put(0b011, 3 + 7);  // the last block, with fixed codes: only its end
    out.fill_byte();
    const auto sum =
        adler32(1, reinterpret_cast<const Bytef*>(planes.data()), static_cast<uInt>(planes.size()));
    for (int byte = 3; byte >= 0; --byte) out.put(static_cast<std::uint32_t>(sum >> 8 * byte & 0xff), 8);
    return out.take();
}

}  // namespace mcdem::io
