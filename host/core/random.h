// Random numbers that do not depend on the standard library: the C++ standard defines the engine (mt19937_64)
// but not the distributions, so those are implemented here.
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace mcdem::inline core {

/// Purpose of a stream of random numbers; streams with the same seed are independent.
enum class Stream : std::uint64_t {
    diameters = 1,
    positions = 2,
    jitter = 3,
    // 4 to 6 and 10: noise of measurements (host/python/mcdem/experiment/keyed_normal.py)
    moduli = 7,
    true_diameters = 8,
    species = 9,
    null_draws = 20,
    bootstrap = 21,
    placebo = 22,
    diameter_jitter = 23,
    challenge = 24,
};

/// splitmix64 (Steele, Lea & Flood 2014): hash that makes consecutive numbers independent.
constexpr std::uint64_t scattered(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/// The seed of the part `number` of what has the seed `seed`: small enough for every file format, and
/// independent for consecutive seeds.
constexpr std::uint64_t derived_seed(std::uint64_t seed, std::uint64_t number) {
    return scattered(scattered(seed) + number) >> 16;
}

/// Uniform in the open interval (0, 1), from the upper bits.
constexpr double unit_interval(std::uint64_t bits) {
    return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53;
}

/// Normal with mean 0 and standard deviation 1 (Box & Muller 1958), from two numbers in (0, 1).
inline double normal_of(double a, double b) {
    return std::sqrt(-2 * std::log(a)) * std::cos(2 * std::numbers::pi * b);
}

class Random {
public:
    Random(std::uint64_t seed, Stream stream)
        : engine_(scattered(scattered(seed) + static_cast<std::uint64_t>(stream))) {}

    /// Uniform in the open interval (0, 1).
    double uniform() { return unit_interval(engine_()); }

    double uniform(double low, double high) { return low + (high - low) * uniform(); }

    /// Normal with mean 0 and standard deviation 1.
    double normal() {
        const double a = uniform();
        return normal_of(a, uniform());
    }

    /// Fisher-Yates shuffle.
    template <class T>
    void shuffle(std::vector<T>& values) {
        for (std::size_t i = values.size(); i > 1; --i) {
            const auto other = static_cast<std::size_t>(uniform() * static_cast<double>(i));
            std::swap(values[i - 1], values[other]);
        }
    }

private:
    std::mt19937_64 engine_;
};

/// Normal distribution truncated to [low, high], by its quantiles.
struct TruncatedNormal {
    double mean, sd;  ///< before truncation
    double low, high;

    /// The value below which a fraction `share` in (0, 1) lies; by bisection, to the last bit.
    double quantile(double share) const {
        if (sd == 0) return mean;
        const auto below = [&](double x) { return 0.5 * std::erfc((mean - x) / (sd * std::numbers::sqrt2)); };
        const double wanted = below(low) + share * (below(high) - below(low));
        double left = low, right = high;
        for (;;) {
            const double middle = left + (right - left) / 2;
            if (middle <= left || middle >= right) return middle;
            (below(middle) < wanted ? left : right) = middle;
        }
    }
};

}  // namespace mcdem::core
