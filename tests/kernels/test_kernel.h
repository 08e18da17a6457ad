// Builds the kernels' program with one additional kernel of a test.
#pragma once
#include <fmt/format.h>

#include "cl/kernel.h"
#include "reference/test_scene.h"
#include "sim/device_types.h"

namespace mcdem::reference {

/// `text` may use LANE(type, value, i): element i modulo LANES of a vector.
inline cl::Program with_kernel(const std::string& text, const KernelBuild& kernels) {
    const std::string lane = "\n#define LANE(type, value, i) (((const type*)&(value))[(i) % LANES])\n";
    cl::Program program(device().context(), mcdem::program_text() + lane + text);
    program.build(
        {device().handle()},
        fmt::format("-w -cl-std=CL1.2 -DMCDEM_DOUBLE={:d} -DLANES={} -DSLOTS={} -DBLOCK={} -DLIST_ITEMS=16",
                    kernels.precision == Precision::double_precision, kernels.lanes, kernels.slots,
                    kernels.block())
            .c_str());
    return program;
}

struct Anything;
/// Memory of the device that a kernel of a test reads or writes.
using Buffer = mcdem::Field<Anything>;

template <class T>
Buffer uploaded(const std::vector<T>& values) {
    Buffer buffer(device(), values.size(), sizeof(T));
    buffer.write(values.data());
    return buffer;
}
template <class T>
Buffer uploaded(const T& value) {
    return uploaded(std::vector<T>{value});
}
/// Room for `count` results, which are zero.
template <class T>
Buffer room_for(std::size_t count) {
    return {device(), count, sizeof(T)};
}
template <class T>
std::vector<T> downloaded(const Buffer& buffer) {
    std::vector<T> values(buffer.bytes() / sizeof(T));
    buffer.read(values.data());
    return values;
}

/// Runs a kernel in `groups` work-groups.
template <class... Buffers>
void launch(const cl::Program& program, const char* name, int work_items, std::size_t groups,
            const Buffers&... buffers) {
    mcdem::Kernel<Buffers...>(device(), program, name, work_items)(groups, buffers...);
}

/// Runs a kernel with the arguments replica, `in` and its result, which has `out` numbers.
inline std::vector<float> mapped(const cl::Program& program, const char* name, int work_items,
                                 std::size_t groups, const mcdem::f32::Replica& replica,
                                 const std::vector<float>& in, std::size_t out) {
    const Buffer to = room_for<float>(out);
    launch(program, name, work_items, groups, uploaded(replica), uploaded(in), to);
    return downloaded<float>(to);
}

/// A test in the layout of the device and in the other one.
class InBothLayouts : public testing::TestWithParam<bool> {
protected:
    void SetUp() override {
        if (!GetParam()) return;
        SKIP_WITHOUT_OTHER_WAY();
        kernels = other_way(kernels);
    }
    KernelBuild kernels = build(Precision::single_precision);
};

/// Applies the OpenCL code `body` to rows of numbers, one work-item per row: it reads `in`, writes `out`,
/// and can use `replica`. `in` has a multiple of `read` numbers; the result has `written` numbers per row.
inline std::vector<float> mapped_rows(const std::string& body, const mcdem::f32::Replica& replica,
                                      const std::vector<float>& in, int read, int written) {
    const cl::Program program = with_kernel(
        fmt::format("kernel void map_rows(global const Replica* replica, global const real* all_in, "
                    "global real* all_out) {{\n"
                    "global const real* in = all_in + get_global_id(0) * {};\n"
                    "global real* out = all_out + get_global_id(0) * {};\n{}\n}}",
                    read, written, body),
        build(Precision::single_precision));
    const std::size_t rows = in.size() / static_cast<std::size_t>(read);
    return mapped(program, "map_rows", 1, rows, replica, in, rows * static_cast<std::size_t>(written));
}

/// Applies the OpenCL code `body` as a step does, one work-group per block of grains: it has the `table` and
/// the `scratch` of its grains and can use `replica`. READ(v, q) is number q of slot v of its grains, `first`
/// and those after it; WRITE(v, q, value) writes number q of the result. `in` has `read` numbers per slot,
/// the result `written`, grain after grain.
inline std::vector<float> mapped_slots(const std::string& body, const mcdem::f32::Replica& replica,
                                       const std::vector<float>& in, int read, int written,
                                       const KernelBuild& kernels) {
    const std::string text = fmt::format(
        "#define ROW(v) (((first + LANE_NUMBERS) * SLOTS + SLOT(v)))\n"
        "#define READ(v, q) gather(in, ROW(v) * {} + (q))\n"
        "#define WRITE(v, q, value) do {{ const lanes all = value; for (int lane = 0; lane < LANES; ++lane) "
        "out[((first + lane) * SLOTS + SLOT(v)) * {} + (q)] = LANE(real, all, lane); }} while (false)\n"
        "WORK_GROUP(STEP_ITEMS) kernel void map_slots(global const Replica* replica, global const real* in, "
        "global real* out) {{\n"
        "MEMORY_OF_WORK_ITEM\n(void)table, (void)scratch;\n"
        "const Block block = {{0, (int)get_group_id(0) * BLOCK}};\n"
        "const int first = FIRST_GRAIN(block);\n{}\n}}",
        read, written, body);
    const std::size_t slots = in.size() / static_cast<std::size_t>(read);
    return mapped(with_kernel(text, kernels), "map_slots", kernels.work_items(),
                  slots / static_cast<std::size_t>(kernels.slots * kernels.block()), replica, in,
                  slots * static_cast<std::size_t>(written));
}

}  // namespace mcdem::reference
