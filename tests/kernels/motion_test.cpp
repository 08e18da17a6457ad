// State of grains: loading, selection and storing, in both layouts.
#include "kernels/test_kernel.h"

namespace mcdem::reference::motions {
namespace {

constexpr int slots = 16, grains = 64, reals = 12;  ///< of a grain in the field Motion

/// Numbers that differ: `grains` rows of 16 slots with three numbers, i.e. four motions per row.
std::vector<float> motions() {
    std::vector<float> all(grains * slots * 3);
    std::iota(all.begin(), all.end(), 1.0F);
    return all;
}

/// Runs `body`, which has `m`, the motion 252 - 4 i of each grain i, and `to`, where motions are written.
std::vector<float> stored(const std::string& body, const KernelBuild& kernels) {
    return mapped_slots(
        "global Motion* to = (global Motion*)out;\n"
        "const slots grain = first + LANE_NUMBERS;\n"
        "const Moving m = load_motion((global const Motion*)in, 252 - 4 * grain);\nif (!IS_LEADER) "
        "return;\n" +
            body,
        {}, motions(), 3, 3, kernels);
}

/// Expects number q of each grain at `place(grain)` of the result to be that of the motion `from(grain, q)`.
void expect_stored(const std::string& body, int (*place)(int), int (*from)(int, int)) {
    const auto in = motions();
    for (const KernelBuild& way : all_ways(build(Precision::single_precision))) {
        const auto found = stored(body, way);
        for (int grain = 0; grain < grains; ++grain)
            for (int q = 0; q < reals; ++q)
                EXPECT_EQ(found[place(grain) * reals + q], in[from(grain, q) * reals + q])
                    << grain << ' ' << q;
    }
}

TEST(MotionState, IsLoadedAndStoredByIndex) {
    expect_stored(
        "store_motion(m, to, 3 * grain);", [](int grain) { return 3 * grain; },
        [](int grain, int) { return 252 - 4 * grain; });
}

// kernels/README.md: position and radius, velocity and excess compliance, angular velocity and species.
TEST(MotionState, HasItsMembersInTheOrderOfTheField) {
    const char* const members[reals] = {"position.x", "position.y", "position.z", "radius",
                                        "velocity.x", "velocity.y", "velocity.z", "excess_compliance",
                                        "spin.x",     "spin.y",     "spin.z",     "species"};
    std::string body;
    for (int q = 0; q < reals; ++q)
        body += fmt::format(
            "for (int lane = 0; lane < LANES; ++lane) out[(first + lane) * {} + {}] = LANE(real, m.{}, "
            "lane);\n",
            reals, q, members[q]);
    expect_stored(
        body, [](int grain) { return grain; }, [](int grain, int) { return 252 - 4 * grain; });
}

// Radius, excess compliance and species do not change in a step; they are those of the second motion.
TEST(MotionState, IsChosenGrainByGrain) {
    expect_stored(
        "const Moving other = load_motion((global const Motion*)in, grain);\n"
        "store_motion(chosen_motion(AS_MASK(grain % 3 == 0), m, other), to, grain);",
        [](int grain) { return grain; },
        [](int grain, int q) { return grain % 3 == 0 && q % 4 != 3 ? 252 - 4 * grain : grain; });
}

}  // namespace
}  // namespace mcdem::reference::motions
