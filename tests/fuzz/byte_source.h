// Interprets the fuzzer's bytes as choices: what to change in a valid file, and how.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace mcdem::fuzz {

class ByteSource {
public:
    ByteSource(const std::uint8_t* bytes, std::size_t size) : bytes_(bytes, size) {}
    bool empty() const { return bytes_.empty(); }
    /// 0 after the last byte.
    std::uint8_t byte() {
        if (bytes_.empty()) return 0;
        const std::uint8_t first = bytes_.front();
        bytes_ = bytes_.subspan(1);
        return first;
    }
    /// Below `count`, which is not 0.
    std::size_t below(std::size_t count) {
        const std::size_t value = byte() | std::size_t(byte()) << 8;
        return value % count;
    }
    /// Extreme numbers for counts and comparisons.
    std::int64_t integer() {
        static constexpr std::int64_t odd[] = {0,
                                               1,
                                               -1,
                                               2,
                                               -2,
                                               16,
                                               255,
                                               256,
                                               1 << 20,
                                               std::numeric_limits<int>::max(),
                                               std::numeric_limits<int>::min(),
                                               std::int64_t{1} << 32,
                                               std::numeric_limits<std::int64_t>::max(),
                                               std::numeric_limits<std::int64_t>::min()};
        return byte() % 4 ? odd[below(std::size(odd))] : byte();
    }
    double number() {
        using Limits = std::numeric_limits<double>;
        static constexpr double odd[] = {0.0,
                                         -0.0,
                                         1,
                                         -1,
                                         1e-300,
                                         1e300,
                                         -1e300,
                                         1e17,
                                         0.5,
                                         Limits::quiet_NaN(),
                                         Limits::infinity(),
                                         -Limits::infinity(),
                                         Limits::denorm_min(),
                                         Limits::max()};
        return byte() % 4 ? odd[below(std::size(odd))] : static_cast<double>(integer());
    }

private:
    std::span<const std::uint8_t> bytes_;
};

}  // namespace mcdem::fuzz
