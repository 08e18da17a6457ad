// Parallel loop over independent tasks.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace mcdem::inline core {

/// Calls work(i) for i below `count` on as many threads as there are cores. If a call throws, no further
/// calls start, and the first exception is rethrown when all threads have ended.
template <class Work>
void in_parallel(std::size_t count, Work work) {
    std::atomic<std::size_t> next{0};
    std::atomic<bool> has_failed{false};
    std::exception_ptr failure;
    const auto take_turns = [&]() noexcept {
        try {
            for (std::size_t i = next++; i < count && !has_failed; i = next++) work(i);
        } catch (...) {
            if (!has_failed.exchange(true)) failure = std::current_exception();
        }
    };
    {
        const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
        std::vector<std::jthread> threads;
        for (std::size_t t = 1; t < std::min(count, cores); ++t) threads.emplace_back(take_turns);
        take_turns();
    }
    if (failure) std::rethrow_exception(failure);
}

}  // namespace mcdem::core
