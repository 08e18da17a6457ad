// Operations on `lanes`: gather, scatter, selection, products.
#include "kernels/test_kernel.h"

namespace mcdem::reference::lanes {
namespace {

constexpr int numbers = 64, grains = 64;

/// Runs a kernel with one work-item per LANES numbers. `text` computes `result` from the numbers `x` and the
/// integers `index` of its lanes.
std::vector<float> by_lanes(const std::string& text, const std::vector<float>& x,
                            const std::vector<int>& index, const KernelBuild& kernels) {
    const cl::Program program = with_kernel(
        "kernel void by_lanes(global const real* all_x, global const int* all_index, "
        "global real4* field, global real* out) {\n"
        "const size_t first = get_group_id(0) * LANES;\n"
        "const lanes x = LOAD_LANES(all_x + first);\n"
        "const slots index = LOAD_LANES(all_index + first);\nlanes result;\n" +
            text + "\nSTORE_LANES(result, out + first);\n}",
        kernels);
    std::vector<float> field(4 * grains);
    std::iota(field.begin(), field.end(), 0.0F);
    const Buffer out = room_for<float>(x.size());
    launch(program, "by_lanes", 1, x.size() / static_cast<std::size_t>(kernels.lanes), uploaded(x),
           uploaded(index), uploaded(field), out);
    return downloaded<float>(out);
}

class Lanes : public InBothLayouts {
protected:
    Lanes() {
        Uniform uniform(8);
        for (int i = 0; i < numbers; ++i) {
            x.push_back(static_cast<float>(std::exp(uniform(-6, 6))));
            index.push_back(static_cast<int>(uniform(0, grains)));
        }
    }
    void expect_lanes(const std::string& text, const std::function<double(double, int)>& expected,
                      double tolerance = 0) const {
        const auto found = by_lanes(text, x, index, kernels);
        for (std::size_t i = 0; i < found.size(); ++i)
            EXPECT_NEAR(found[i], expected(x[i], index[i]), tolerance * std::abs(expected(x[i], index[i])))
                << text << ", number " << i;
    }
    std::vector<float> x;
    std::vector<int> index;
};

TEST_P(Lanes, GatherReadsEveryComponentOfTheRequestedRows) {
    const char* const component[] = {"x", "y", "z", "w"};
    for (int c = 0; c < 4; ++c)
        expect_lanes(std::string("result = gather4(field, index).") + component[c] + ";",
                     [c](double, int i) { return 4 * i + c; });
    expect_lanes("result = gather((global const real*)field, index);", [](double, int i) { return i; });
}

TEST_P(Lanes, WhereSelectsLaneByLane) {
    expect_lanes("result = WHERE(AS_MASK(index < 20), x, -x);",
                 [](double number, int i) { return i < 20 ? number : -number; });
    expect_lanes("result = where3(AS_MASK(index < 20), (lanes3){x, x, x}, ZERO3).z;",
                 [](double number, int i) { return i < 20 ? number : 0; });
}

TEST_P(Lanes, ScatterWritesEveryComponentOfTheRequestedRows) {
    const char* const component[] = {"x", "y", "z", "w"};
    for (int c = 0; c < 4; ++c)  // rows in reverse order, each read by the lane that wrote it
        expect_lanes(
            std::string("const slots row = 63 - ((int)first + LANE_NUMBERS);\n"
                        "scatter4((lanes4){x, R(2) * x, R(3) * x, R(4) * x}, field, row);\n"
                        "result = gather4(field, row).") +
                component[c] + ";",
            [c](double number, int) { return (c + 1) * number; }, 1e-7);
}

// The 16 grains of a work-item are side by side; on a GPU the slots of a grain.
TEST_P(Lanes, SlotsAreStoredAsVectorsOfGrains) {
    const auto found = by_lanes("result = load_slot((global const real*)field, FIRST_SLOT(first % 16), 6);",
                                x, index, kernels);
    for (std::size_t grain = 0; grain < 16; ++grain)
        EXPECT_EQ(found[grain], kernels.place_of_slot(grain, kernels.lanes > 1 ? 6 : 0));
}

TEST(KernelBuild, PlacesOfSlotsBelongToTheirGrains) {
    for (const int lanes : {1, 16}) {
        const KernelBuild kernels{.slots = 32, .lanes = lanes};
        std::vector<bool> used(64 * 32, false);
        for (std::size_t grain = 0; grain < 64; ++grain)
            for (std::size_t slot = 0; slot < 32; ++slot) {
                const std::size_t place = kernels.place_of_slot(grain, slot);
                ASSERT_LT(place, used.size());
                EXPECT_FALSE(used[place]);
                used[place] = true;
                EXPECT_EQ(kernels.grain_of_slot(place), grain);
            }
    }
}

// True for all lanes on a CPU; on a GPU only for the lane itself.
TEST_P(Lanes, AnyIsTrueIfOneLaneIs) {
    for (int one = 0; one <= 16; ++one) {  // the last value: no lane
        x.assign(16, 0);
        index.assign(16, 0);
        std::vector<float> expected(16, kernels.lanes > 1 && one < 16 ? 1.0F : 0.0F);
        if (one < 16) index[static_cast<std::size_t>(one)] = expected[static_cast<std::size_t>(one)] = 1;
        EXPECT_EQ(by_lanes("result = ANY(AS_MASK(index == 1)) ? R(1) : R(0);", x, index, kernels), expected);
    }
}

// In float a Newton step refines an estimate; the relative error is 3e-7.
TEST_P(Lanes, InverseRootIsPrecise) {
    expect_lanes(
        "result = inverse_root(x);", [](double number, int) { return 1 / std::sqrt(number); }, 3e-7);
}

TEST_P(Lanes, VectorProductsAgreeWithClosedForms) {
    const std::string vectors = "const lanes3 a = {x, R(2) * x, R(0.5)}, b = {R(3), x, R(1)};\n";
    expect_lanes(
        vectors + "result = dot3(a, b);", [](double n, int) { return 3 * n + 2 * n * n + 0.5; }, 1e-6);
    expect_lanes(
        vectors + "result = cross3(a, b).z;", [](double n, int) { return n * n - 6 * n; }, 1e-4);
    expect_lanes(
        vectors + "result = add_scaled3(a, x, b).y;", [](double n, int) { return 2 * n + n * n; }, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(BothLayouts, Lanes, testing::Bool());

}  // namespace
}  // namespace mcdem::reference::lanes
