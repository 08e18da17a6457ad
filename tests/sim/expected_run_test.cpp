// What is expected of a run, against runs.
#include "sim/expected_run.h"

#include <gtest/gtest.h>

#include "scene/packing/make_packing.h"
#include "scene/read/read_scene.h"
#include "sim/device_replica.h"
#include "sim/simulation.h"

namespace mcdem {
namespace {

/// A bed of 120 grains between periodic sides.
std::string bed(double scale, double youngs_modulus, double density) {
    return fmt::format(
        "[container]\nshape = \"periodic\"\nsize_x = {0}\nsize_y = {0}\n[grains]\nyoungs_modulus = {1}\n"
        "density = {2}\nexcess_density = {2}\n[contact]\nmodel = \"independent\"\n[packing]\ncount = 120\n"
        "diameter_mean = {3}\ndiameter_sd = {4}\ndiameter_min = {5}\ndiameter_max = {6}\n"
        "[plate]\nstart = {7}\nend = {8}\n[protocol]\nscans_per_stroke = 2\n[walls]\nyoungs_modulus = {9}\n",
        4.5 * scale, youngs_modulus, density, scale, 0.1 * scale, 0.8 * scale, 1.2 * scale, 5.4 * scale,
        4.8 * scale, 100 * youngs_modulus);
}

struct Seen {
    double steps = 0, force = 0, first_progress = 0;
};
Seen run(const Scene& scene) {
    Device device;
    Simulation simulation(device, scene, {make_packing(scene.replicas[0])});
    Seen seen;
    const auto note = [&](int, const Scan& scan) { seen.force = std::max(seen.force, scan.top_force()); };
    while (simulation.advance(note, [](int, const Failure&) {}))
        if (seen.first_progress == 0) seen.first_progress = simulation.progress();
    seen.steps = static_cast<double>(simulation.grain_steps()) / 120;
    return seen;
}

/// Soft grains of centimetres, and a powder of 50 micrometres. A user needs to know whether a run takes
/// minutes or days: a factor of three is good enough. Steps depend on how often grains rearrange.
TEST(ExpectedRun, ForceAndStepsAreThoseOfRuns) {
    for (const auto& [scale, modulus, density] :
         {std::tuple(0.02, 23.3e3, 11.5), std::tuple(50e-6, 1e9, 1500.0)}) {
        const Scene scene = parse_scene(bed(scale, modulus, density), "bed.toml", {});
        const Replica& replica = scene.replicas[0];
        const double step = time_step(replica, 0.4 * scale), area = 4.5 * 4.5 * scale * scale;
        const ExpectedRun expected = expected_run(replica, expected_scale(replica), step);
        const Seen seen = run(scene);
        EXPECT_GT(seen.force, expected.at_lowest.low * area);
        EXPECT_LT(seen.force, expected.at_lowest.high * area);
        EXPECT_GT(seen.steps, expected.programme_steps / 3);
        EXPECT_LT(seen.steps, 3 * expected.programme_steps);
        EXPECT_LE(expected.relax_steps, 20'001) << "stiff grains do not relax for a second";
        EXPECT_GT(seen.first_progress, 0) << "the relaxation is part of the progress";
    }
}

TEST(ExpectedRun, HeightIsThatOfTheGeneratedPacking) {
    const Scene scene = parse_scene(bed(0.02, 23.3e3, 11.5), "bed.toml", {});
    const double top = scale_of(scene.replicas[0], make_packing(scene.replicas[0])).top;
    EXPECT_NEAR(expected_scale(scene.replicas[0]).top, top, 0.02 * top);
}

}  // namespace
}  // namespace mcdem
