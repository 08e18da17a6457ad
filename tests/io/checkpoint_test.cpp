#include "io/checkpoint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "core/errors.h"
#include "io/hdf5.h"
#include "io/synthetic_run.h"

namespace mcdem::test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Checkpoint example(int segments) {
    Checkpoint checkpoint{"name = 1\n", "a device", segments, {}};
    std::mt19937 random(static_cast<unsigned>(segments));
    for (const auto& [name, size] :
         {std::pair("positions", 100000), std::pair("status", 3), std::pair("none", 0)})
        for (int i = 0; i < size; ++i) checkpoint.fields[name].push_back(static_cast<std::byte>(random()));
    checkpoint.fields["none"];
    return checkpoint;
}

void expect_same_checkpoint(const Checkpoint& a, const Checkpoint& b) {
    EXPECT_EQ(a.scene_text, b.scene_text);
    EXPECT_EQ(a.device, b.device);
    EXPECT_EQ(a.segments, b.segments);
    EXPECT_TRUE(a.fields == b.fields);
}

TEST(checkpoint, is_read_back_bit_for_bit) {
    TestFolder folder;
    EXPECT_FALSE(read_checkpoint(folder.path).has_value());
    write_checkpoint(folder.path, example(3));
    const auto found = read_checkpoint(folder.path);
    ASSERT_TRUE(found.has_value());
    expect_same_checkpoint(example(3), *found);
}

TEST(checkpoint, is_replaced_and_removed) {
    TestFolder folder;
    write_checkpoint(folder.path, example(3));
    write_checkpoint(folder.path, example(4));
    expect_same_checkpoint(example(4), read_checkpoint(folder.path).value());
    remove_checkpoint(folder.path);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path));
}

TEST(checkpoint, a_damaged_one_is_refused_with_advice) {
    TestFolder folder;
    write_bytes(folder / "checkpoint.h5", "no");
    EXPECT_THAT([&] { read_checkpoint(folder.path); },
                ThrowsMessage<InputError>(HasSubstr("start the run again in another folder")));
}

h5::Handle opened_to_change(const TestFolder& folder) {
    return {H5Fopen((folder / "checkpoint.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose};
}

TEST(checkpoint, a_removed_field_is_detected) {
    TestFolder folder;
    write_checkpoint(folder.path, example(5));
    ASSERT_GE(H5Ldelete(opened_to_change(folder), "/checkpoint/fields/status", H5P_DEFAULT), 0);
    EXPECT_THAT([&] { read_checkpoint(folder.path); }, ThrowsMessage<InputError>(HasSubstr("must have ")));
}

TEST(checkpoint, any_flipped_bit_is_detected_or_harmless) {
    TestFolder folder;
    const Checkpoint written = example(5);
    write_checkpoint(folder.path, written);
    const std::string whole = bytes_of_file(folder / "checkpoint.h5");
    std::mt19937_64 random(7);
    int noticed = 0;
    for (int trial = 0; trial < 200; ++trial) {
        std::string bytes = whole;
        bytes[random() % bytes.size()] ^= static_cast<char>(1 << random() % 8);
        write_bytes(folder / "checkpoint.h5", bytes);
        try {
            expect_same_checkpoint(written,
                                   read_checkpoint(folder.path).value());  // a bit in a gap between objects
        } catch (const InputError&) {
            ++noticed;
        }
    }
    EXPECT_GT(noticed, 100);
}

}  // namespace
}  // namespace mcdem::test
