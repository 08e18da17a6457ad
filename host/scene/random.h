// Random numbers that are the same with every standard library: the standard fixes the engine
// (mt19937_64) but not the distributions, so those are written here.
#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace mcdem {

/// What a stream of random numbers is for: streams of one seed do not repeat one another.
enum class Stream : std::uint64_t { diameters = 1, positions = 2, jitter = 3 };

class Random {
public:
    Random(std::uint64_t seed, Stream stream)
        : engine_(mix(mix(seed) + static_cast<std::uint64_t>(stream))) {}

    /// Uniform in the open interval (0, 1).
    double uniform() { return (static_cast<double>(engine_() >> 11) + 0.5) * 0x1p-53; }

    double uniform(double low, double high) { return low + (high - low) * uniform(); }

    /// Normal with mean 0 and standard deviation 1 (Box & Muller 1958; one of the pair is dropped).
    double normal() {
        const double radius = std::sqrt(-2 * std::log(uniform()));
        return radius * std::cos(2 * std::numbers::pi * uniform());
    }

    /// Fisher & Yates.
    template <class T>
    void shuffle(std::vector<T>& values) {
        for (std::size_t i = values.size(); i > 1; --i) {
            const auto other = static_cast<std::size_t>(uniform() * static_cast<double>(i));
            std::swap(values[i - 1], values[other]);
        }
    }

private:
    /// splitmix64 (Steele, Lea & Flood 2014): neighbouring seeds give unrelated engines.
    static std::uint64_t mix(std::uint64_t x) {
        x += 0x9e3779b97f4a7c15u;
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
        return x ^ (x >> 31);
    }

    std::mt19937_64 engine_;
};

/// A normal distribution cut to [low, high], by its quantiles.
struct TruncatedNormal {
    double mean, sd;  ///< of the normal distribution before the cut
    double low, high;

    /// The value below which a share `share` in (0, 1) lies: bisection, to the last bit.
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

}  // namespace mcdem
