// Random numbers for drawing programmes, the same on every machine.
#pragma once
#include <random>

namespace mcdem {

class RandomDraws {
public:
    explicit RandomDraws(unsigned seed) : engine_(seed) {}

protected:
    double between(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
    }
    int whole(int low, int high) {
        return low + static_cast<int>(engine_() % static_cast<unsigned>(high - low + 1));
    }

private:
    std::mt19937_64 engine_;
};

}  // namespace mcdem
