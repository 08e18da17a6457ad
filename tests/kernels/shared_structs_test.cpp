// Structs shared by host and device (material.h, replica.h, report.h) have the same layout on both.
#include <regex>

#include "kernels/test_kernel.h"

namespace mcdem::reference {
namespace {

/// Names of a struct's members, from the text of the kernels.
std::vector<std::string> members_of(const std::string& type) {
    const std::string text = mcdem::program_text();
    const auto end = text.find("} " + type + ";"), begin = text.rfind("typedef struct {", end);
    const std::string body = text.substr(begin, end - begin);
    const std::regex member(R"(\b(?:real|int|Material) (\w+)(?:\[[^\]]*\])?;)");
    std::vector<std::string> names;
    for (std::sregex_iterator found(body.begin(), body.end(), member); found != std::sregex_iterator();
         ++found)
        names.push_back((*found)[1]);
    return names;
}

/// A struct of the kernels and its size on the host.
struct Shared {
    std::string type;
    int size;
};

/// On the device: of each struct its size, then offset and size of each member.
std::vector<int> device_layout(const std::vector<Shared>& structs, Precision precision) {
    std::string lines;
    std::size_t count = 0;
    const auto write = [&](const std::string& number) {
        lines += fmt::format("out[{}] = (int)({});\n", count++, number);
    };
    for (const auto& [type, size] : structs) {
        write(fmt::format("sizeof({})", type));
        for (const std::string& member : members_of(type)) {
            write(fmt::format("(size_t)&((({}*)0)->{})", type, member));
            write(fmt::format("sizeof((({}*)0)->{})", type, member));
        }
    }
    const Buffer out = room_for<int>(count);
    launch(with_kernel("kernel void lay_out(global int* out) {\n" + lines + "}", build(precision)), "lay_out",
           1, 1, out);
    return downloaded<int>(out);
}

/// The members fill each struct without gaps on the device, and the host's struct has the same size. It has
/// the same members in the same order, from the same text, and therefore no gaps either. `real`: of a real.
void expect_same_layout(const std::vector<Shared>& structs, int real, Precision precision) {
    const auto layout = device_layout(structs, precision);
    auto number = layout.begin();
    for (const auto& [type, size] : structs) {
        EXPECT_EQ(*number++, size) << type;
        int end = 0;
        for (const std::string& member : members_of(type)) {
            EXPECT_EQ(*number++, end) << type << ", " << member;
            end += *number++;
        }
        EXPECT_TRUE(end <= size && size < end + real) << type << ": the last number may be padded";
    }
}

TEST(SharedStructs, HaveTheSameLayoutInFloat) {
    expect_same_layout({{"Material", sizeof(mcdem::f32::Material)},
                        {"Replica", sizeof(mcdem::f32::Replica)},
                        {"Report", sizeof(mcdem::f32::Report)}},
                       sizeof(float), Precision::single_precision);
}

TEST(SharedStructs, HaveTheSameLayoutInDouble) {
    if (!has_double()) GTEST_SKIP() << "the device has no double precision";
    expect_same_layout({{"Material", sizeof(mcdem::f64::Material)},
                        {"Replica", sizeof(mcdem::f64::Replica)},
                        {"Report", sizeof(mcdem::f64::Report)}},
                       sizeof(double), Precision::double_precision);
}

}  // namespace
}  // namespace mcdem::reference
