// Vectors of contacts: what is read from scattered places, chosen and multiplied, slot by slot.
#include "kernels/test_kernel.h"

namespace reference {
namespace {

constexpr int slots = 16, grains = 64;

/// What a kernel of one work-group for each grain writes, a row of 16 numbers: `text` has the 16 numbers `x`
/// and the integers `index` of its grain, and sets `result`.
std::vector<float> by_slots(const std::string& text, const std::vector<float>& x,
                            const std::vector<int>& index, const KernelBuild& kernels) {
    const cl::Program program = with_kernel(
        "kernel void by_slots(global const real* all_x, global const int* all_index, "
        "global const real4* field, global real* out) {\n"
        "const size_t row = get_group_id(0) * 16;\n"
        "const lanes x = LOAD_LANES(all_x + row, 0);\n"
        "const slots index = LOAD_LANES(all_index + row, 0);\nlanes result;\n" +
            text + "\nSTORE_LANES(result, out + row, 0);\n}",
        kernels);
    struct X;
    struct Index;
    struct Rows;
    struct Out;
    std::vector<float> field(4 * grains);
    for (std::size_t i = 0; i < field.size(); ++i) field[i] = static_cast<float>(i);
    mcdem::Field<X> from(device(), x.size(), sizeof(float));
    mcdem::Field<Index> at(device(), index.size(), sizeof(int));
    mcdem::Field<Rows> rows(device(), grains, 4 * sizeof(float));
    mcdem::Field<Out> to(device(), x.size(), sizeof(float));
    from.write(x.data());
    at.write(index.data());
    rows.write(field.data());
    mcdem::Kernel<mcdem::Field<X>, mcdem::Field<Index>, mcdem::Field<Rows>, mcdem::Field<Out>>(
        device(), program, "by_slots", kernels.lanes == 16 ? 1 : slots)(x.size() / slots, from, at, rows, to);
    std::vector<float> out(x.size());
    to.read(out.data());
    return out;
}

class Lanes : public testing::TestWithParam<bool> {
protected:
    Lanes() {
        if (GetParam()) kernels = other_way(kernels);
        Uniform uniform(8);
        for (int i = 0; i < 4 * slots; ++i) {
            x.push_back(static_cast<float>(std::exp(uniform(-6, 6))));
            index.push_back(static_cast<int>(uniform(0, grains)));
        }
    }
    void expect_slots(const std::string& text, const std::function<double(double, int)>& expected,
                      double tolerance = 0) const {
        const auto found = by_slots(text, x, index, kernels);
        for (std::size_t i = 0; i < found.size(); ++i)
            EXPECT_NEAR(found[i], expected(x[i], index[i]), tolerance * std::abs(expected(x[i], index[i])))
                << text << ", slot " << i;
    }
    KernelBuild kernels = build(Precision::single_precision);
    std::vector<float> x;
    std::vector<int> index;
};

TEST_P(Lanes, GatherReadsEveryComponentOfTheRowsAsked) {
    const char* const component[] = {"x", "y", "z", "w"};
    for (int c = 0; c < 4; ++c)
        expect_slots(std::string("result = gather4(field, index).") + component[c] + ";",
                     [c](double, int i) { return 4 * i + c; });
    expect_slots("result = gather((global const real*)field, index);", [](double, int i) { return i; });
}

TEST_P(Lanes, WhereChoosesSlotBySlot) {
    expect_slots("result = WHERE(AS_MASK(index < 20), x, -x);",
                 [](double number, int i) { return i < 20 ? number : -number; });
    expect_slots("result = where3(AS_MASK(index < 20), (lanes3){x, x, x}, ZERO3).z;",
                 [](double number, int i) { return i < 20 ? number : 0; });
}

// Of a grain on a CPU, of a work-item's own slot on a GPU.
TEST_P(Lanes, AnyTellsWhetherSomeSlotIs) {
    x.assign(slots, 0);
    for (int slot = 0; slot <= slots; ++slot) {  // the last: none
        index.assign(slots, 0);
        std::vector<float> expected(slots, kernels.lanes == 16 && slot < slots ? 1.0F : 0.0F);
        if (slot < slots)
            index[static_cast<std::size_t>(slot)] = expected[static_cast<std::size_t>(slot)] = 1;
        EXPECT_EQ(by_slots("result = ANY(AS_MASK(index == 1)) ? R(1) : R(0);", x, index, kernels), expected);
    }
}

// In float an estimate and a step of Newton's method: 3e-7.
TEST_P(Lanes, InverseRootIsPrecise) {
    expect_slots(
        "result = inverse_root(x);", [](double number, int) { return 1 / std::sqrt(number); }, 3e-7);
}

TEST_P(Lanes, ProductsOfVectorsAreThoseOfGeometry) {
    const std::string vectors = "const lanes3 a = {x, R(2) * x, R(0.5)}, b = {R(3), x, R(1)};\n";
    expect_slots(
        vectors + "result = dot3(a, b);", [](double n, int) { return 3 * n + 2 * n * n + 0.5; }, 1e-6);
    expect_slots(
        vectors + "result = cross3(a, b).z;", [](double n, int) { return n * n - 6 * n; }, 1e-4);
    expect_slots(
        vectors + "result = add_scaled3(a, x, b).y;", [](double n, int) { return 2 * n + n * n; }, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(BothWays, Lanes, testing::Bool());

}  // namespace
}  // namespace reference
