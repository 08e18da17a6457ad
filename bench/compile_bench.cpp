// Time from program start to the first two steps of the first packing, including compilation of the kernels.
// Run it with an empty cache folder for a cold start (bench/run does: POCL_CACHE_DIR, CUDA_CACHE_PATH), and
// again for a warm start.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <exception>

#include "bench/device_context.h"
#include "sim/engine.h"

namespace {

using namespace mcdem;

/// Two grains that just touch.
Packing pair() { return {{{0.05, 0.05, 0.011}, {0.05, 0.05, 0.031}}, {0.02, 0.02}}; }

void compile(benchmark::State& state, Precision precision) {
    try {
        for (auto _ : state) {
            Device device;
            Engine engine(device, kernel_build(device, precision, 16), {Replica{}}, {pair()});
            const auto results = engine.advance({{2, Replica{}.plate.start, 0, 0}});
            if (results[0].status || results[0].steps != 2) state.SkipWithError("the two steps failed");
        }
    } catch (const std::exception& error) {
        state.SkipWithError(error.what());
    }
}

}  // namespace

int main(int argc, char** argv) {
    for (const auto precision : {Precision::single_precision, Precision::double_precision})
        benchmark::RegisterBenchmark(std::string(mcdem::name(precision)).c_str(),
                                     [precision](benchmark::State& state) { compile(state, precision); })
            ->UseRealTime()
            ->Iterations(1)
            ->Unit(benchmark::kMillisecond);
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    try {
        mcdem::bench::add_device_context(Device());
        benchmark::RunSpecifiedBenchmarks();
    } catch (const std::exception& error) {
        fmt::print(stderr, "compile_bench: {}\n", error.what());
        return 1;
    }
    return 0;
}
