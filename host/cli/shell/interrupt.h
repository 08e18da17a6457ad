// Ctrl-C and SIGTERM: the first asks for an end in good order, the second ends the program at once.
#pragma once
#include <signal.h>

namespace mcdem::inline cli {

/// Listens as long as it lives.
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
