// Limits of the machine as reached through OpenCL, for comparison with the step benchmarks.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <fstream>
#include <stdexcept>

#include "bench/device_context.h"

namespace {

using benchmark::Counter;
using mcdem::Device;

constexpr int fma_rounds = 4096;
constexpr int chains = 12;
constexpr int lanes_of_cpu = 16;

cl::Program machine_program(const Device& device) {
    const std::string file = MCDEM_BENCH_SOURCES "/machine.cl";
    std::ifstream input(file);
    if (!input) throw std::runtime_error("cannot read " + file);
    cl::Program program(device.context(), std::string{std::istreambuf_iterator<char>(input), {}});
    const std::string chain =
        device.info().gpu ? "-Dchain=float -DFIRST_LANE(v)=(v)" : "-Dchain=float16 -DFIRST_LANE(v)=(v).s0";
    program.build({device.handle()},
                  fmt::format("-cl-std=CL1.2 {} -DFMA_ROUNDS={}", chain, fma_rounds).c_str());
    return program;
}

/// Three arrays much larger than any cache.
void triad(benchmark::State& state, Device& device, const cl::Program& program) {
    const std::size_t bytes = device.info().gpu ? std::size_t{1} << 30 : std::size_t{1} << 28;
    const std::size_t floats = bytes / sizeof(float);
    cl::Buffer a(device.context(), CL_MEM_READ_WRITE, bytes), b(device.context(), CL_MEM_READ_WRITE, bytes),
        c(device.context(), CL_MEM_READ_WRITE, bytes);
    device.queue().enqueueFillBuffer(b, 1.0f, 0, bytes);
    device.queue().enqueueFillBuffer(c, 2.0f, 0, bytes);
    cl::Kernel kernel(program, "triad");
    kernel.setArg(0, a);
    kernel.setArg(1, b);
    kernel.setArg(2, c);
    kernel.setArg(3, 3.0f);
    const auto run = [&] {
        device.queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(floats / 16),
                                            cl::NDRange(256));
        device.finish();
    };
    run();
    float last = 0;
    device.queue().enqueueReadBuffer(a, CL_TRUE, bytes - sizeof(float), sizeof(float), &last);
    if (last != 7) return state.SkipWithError("the triad's result is wrong");
    for (auto _ : state) run();
    state.counters["bytes_per_s"] = Counter(3.0 * bytes * state.iterations(), Counter::kIsRate);
}

void multiply_add(benchmark::State& state, Device& device, const cl::Program& program) {
    const bool gpu = device.info().gpu;
    const std::size_t group = gpu ? 256 : 16;
    const std::size_t items = group * device.info().compute_units * (gpu ? 64 : 16);
    cl::Buffer out(device.context(), CL_MEM_READ_WRITE, items * sizeof(float));
    cl::Kernel kernel(program, "multiply_add");
    kernel.setArg(0, out);
    kernel.setArg(1, 0.5f);
    kernel.setArg(2, 1.0f);  // x = x / 2 + 1 converges to 2
    const auto run = [&] {
        device.queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(items), cl::NDRange(group));
        device.finish();
    };
    run();
    float first = 0;
    device.queue().enqueueReadBuffer(out, CL_TRUE, 0, sizeof(float), &first);
    if (std::abs(first - 2.0f * chains) > 1e-3f)
        return state.SkipWithError("the sum of multiply-adds is wrong");
    for (auto _ : state) run();
    const double flops = 2.0 * chains * fma_rounds * (gpu ? 1 : lanes_of_cpu) * items;
    state.counters["flops_per_s"] = Counter(flops * state.iterations(), Counter::kIsRate);
}

/// One launch after another in one queue, with a wait at the end of an interval.
void launch(benchmark::State& state, Device& device, const cl::Program& program) {
    constexpr int launches = 100;
    cl::Buffer out(device.context(), CL_MEM_READ_WRITE, 64);
    cl::Kernel kernel(program, "nothing");
    kernel.setArg(0, out);
    for (auto _ : state) {
        for (int n = 0; n < launches; ++n)
            device.queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(16), cl::NDRange(16));
        device.finish();
    }
    state.counters["launches_per_s"] = Counter(double(launches) * state.iterations(), Counter::kIsRate);
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    try {
        Device device;
        mcdem::bench::add_device_context(device);
        const cl::Program program = machine_program(device);
        const auto add = [&](const char* name, auto function) {
            benchmark::RegisterBenchmark(name,
                                         [&, function](benchmark::State& s) { function(s, device, program); })
                ->UseRealTime()
                ->Unit(benchmark::kMicrosecond);
        };
        add("memory_bandwidth", triad);
        add("multiply_add", multiply_add);
        add("launch", launch);
        benchmark::RunSpecifiedBenchmarks();
    } catch (const std::exception& error) {
        fmt::print(stderr, "machine_bench: {}\n", error.what());
        return 1;
    }
    return 0;
}
