// Independent pieces of work on all cores.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace mcdem {

/// Calls work(i) for i below `count` on as many threads as there are cores. The work must not throw.
template <class Work>
void in_parallel(std::size_t count, Work work) {
    std::atomic<std::size_t> next{0};
    const auto take_turns = [&] {
        for (std::size_t i = next++; i < count; i = next++) work(i);
    };
    const std::size_t cores = std::max(1u, std::thread::hardware_concurrency());
    std::vector<std::jthread> threads;
    for (std::size_t t = 1; t < std::min(count, cores); ++t) threads.emplace_back(take_turns);
    take_turns();
}

}  // namespace mcdem
