// Ctrl-C and SIGTERM: the first one requests a clean end, the second one ends the program immediately.
#pragma once
#include <signal.h>

namespace mcdem::inline cli {

/// Handles signals during its lifetime.
class Interrupt {
public:
    Interrupt();
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;
    static bool wanted();

private:
    struct sigaction before_int_ {
    }, before_term_{};
};

}  // namespace mcdem::cli
