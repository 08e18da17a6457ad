// Grain-steps per second in dense packings with all features. Every case is checked before it is timed.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <exception>
#include <memory>

#include "bench/device_context.h"
#include "bench/moving_plate.h"
#include "bench/step_cost.h"

namespace {

using namespace mcdem;
using namespace mcdem::bench;

/// Google Benchmark calls a function several times to determine the number of repetitions, so the last case
/// is kept.
struct Kept {
    std::string name;
    std::unique_ptr<MovingPlate> plate;
};

MovingPlate& checked(Device& device, Kept& kept, const std::string& name, const StepCase& wanted) {
    if (kept.name != name) {
        kept = {};  // frees the device before the next case
        auto plate = std::make_unique<MovingPlate>(device, wanted, MCDEM_BENCH_CACHE);
        check_before_timing(device, *plate, MCDEM_BENCH_CACHE);
        kept = {name, std::move(plate)};
    }
    return *kept.plate;
}

void measure(benchmark::State& state, Device& device, Kept& kept, const std::string& name,
             const StepCase& wanted) {
    try {
        MovingPlate& plate = checked(device, kept, name, wanted);
        for (auto _ : state) plate.round();
        const double steps = static_cast<double>(state.iterations()) * MovingPlate::round_steps;
        const double grain_steps = steps * wanted.grains * wanted.replicas;
        const double contacts = plate.coordination_number();
        const StepCost cost = step_cost(wanted.model, wanted.friction, wanted.precision);
        const auto rate = [](double amount) {
            return benchmark::Counter(amount, benchmark::Counter::kIsRate);
        };
        state.counters["grain_steps_per_s"] = rate(grain_steps);
        state.counters["steps_per_s"] = rate(steps);
        state.counters["counted_bytes_per_s"] = rate(grain_steps * cost.bytes);
        state.counters["counted_flops_per_s"] = rate(grain_steps * cost.flops);
        state.counters["counted_bytes"] = cost.bytes;
        state.counters["counted_flops"] = cost.flops;
        state.counters["contacts_per_grain"] = contacts;
        state.counters["device_bytes_per_grain"] = plate.bytes_per_grain();
    } catch (const std::exception& error) {
        state.SkipWithError(error.what());
    }
}

std::vector<StepCase> cases() {
    using enum ContactModel;
    using enum FrictionLaw;
    std::vector<StepCase> all;
    for (const auto model : {mc_dem, independent, elastic_sphere, hyperelastic_sphere}) {
        for (const auto& [grains, replicas] : {std::pair{514, 1}, {514, 64}, {514, 256}, {50'000, 1}})
            all.push_back({model, saturated, grains, replicas});
        all.push_back({model, mindlin, 50'000, 1});
    }
    all.push_back({mc_dem, mindlin, 514, 64});
    all.push_back({mc_dem, saturated, 50'000, 1, Precision::double_precision});
    for (const int grains : {1'000, 10'000, 100'000, 200'000, 500'000, 1'000'000})
        all.push_back({mc_dem, saturated, grains, 1});
    return all;
}

std::string title(const StepCase& c) {
    return fmt::format("{}/{}/{}/grains:{}/replicas:{}", name(c.model), name(c.friction), name(c.precision),
                       c.grains, c.replicas);
}

}  // namespace

int main(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    try {
        Device device;
        bench::add_device_context(device);
        Kept kept;
        for (const StepCase& wanted : cases()) {
            if (wanted.precision == Precision::double_precision && !device.info().double_precision) continue;
            const std::string text = title(wanted);
            benchmark::RegisterBenchmark(text.c_str(),
                                         [&device, &kept, text, wanted](benchmark::State& state) {
                                             measure(state, device, kept, text, wanted);
                                         })
                ->UseRealTime()
                ->Unit(benchmark::kMillisecond);
        }
        benchmark::RunSpecifiedBenchmarks();
    } catch (const std::exception& error) {
        fmt::print(stderr, "step_bench: {}\n", error.what());
        return 1;
    }
    return 0;
}
