// Signals wait while a driver compiles.
#pragma once
#include <signal.h>

#include <array>

namespace mcdem::inline opencl {

/// Blocks the signals that end a program, in this thread and in threads that it starts, during its lifetime,
/// and then restores their handlers. LLVM, with which PoCL compiles, handles them even if they are ignored
/// (nohup) and deletes the files that it is writing.
class HeldSignals {
public:
    HeldSignals() {
        sigset_t held;
        sigemptyset(&held);
        for (const int signal : signals) sigaddset(&held, signal);
        pthread_sigmask(SIG_BLOCK, &held, &mask_);
        for (std::size_t k = 0; k < signals.size(); ++k) sigaction(signals[k], nullptr, &actions_[k]);
    }
    ~HeldSignals() {
        for (std::size_t k = 0; k < signals.size(); ++k) sigaction(signals[k], &actions_[k], nullptr);
        pthread_sigmask(SIG_SETMASK, &mask_, nullptr);
    }
    HeldSignals(const HeldSignals&) = delete;
    HeldSignals& operator=(const HeldSignals&) = delete;

private:
    static constexpr std::array signals{SIGHUP, SIGINT, SIGTERM, SIGUSR1, SIGUSR2};
    sigset_t mask_{};
    std::array<struct sigaction, signals.size()> actions_{};
};

}  // namespace mcdem::opencl
