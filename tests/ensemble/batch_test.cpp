// The results of a replica are bit-identical alone, in batches of any size, and at any position in them.
#include <gmock/gmock.h>

#include "ensemble/make_packings.h"
#include "ensemble/recording_bits.h"
#include "ensemble/small_scene.h"

namespace mcdem {
namespace {

/// The replicas of `scene` with these indices, in this order.
std::vector<std::string> bits_of_batch(Device& device, const Scene& scene, const std::vector<int>& numbers) {
    Scene batch = scene;
    batch.replicas.clear();
    for (int r : numbers) batch.replicas.push_back(scene.replicas[r]);
    std::vector<std::string> bits;
    for (const auto& recording : simulate(device, batch, make_packings(batch)))
        bits.push_back(bits_of(recording));
    return bits;
}

/// Replicas that differ in model, friction law, grains and seed.
Scene mixed_scene() {
    Scene scene =
        small_scene({"batch.replicas=2", "batch.vary.contact.friction_law=[\"saturated\", \"mindlin\"]"});
    for (std::size_t r = 0; r < scene.replicas.size(); ++r)
        std::get<GeneratedPacking>(scene.replicas[r].packing.source).count = 17 + 2 * static_cast<int>(r);
    return scene;
}

TEST(Batch, ReplicaDoesNotDependOnTheOthers) {
    Device device;
    const Scene scene = mixed_scene();
    ASSERT_EQ(scene.replicas.size(), 8u);
    const auto together = bits_of_batch(device, scene, {0, 1, 2, 3, 4, 5, 6, 7});
    for (int r : {0, 5, 7}) {
        ASSERT_FALSE(together[r].empty());
        EXPECT_TRUE(bits_of_batch(device, scene, {r})[0] == together[r]) << r;
    }
    const auto elsewhere = bits_of_batch(device, scene, {7, 5, 5, 0, 3});
    EXPECT_TRUE(elsewhere[0] == together[7]);
    EXPECT_TRUE(elsewhere[1] == together[5]);
    EXPECT_TRUE(elsewhere[2] == together[5]);
    EXPECT_TRUE(elsewhere[3] == together[0]);
    EXPECT_TRUE(elsewhere[4] == together[3]);
    EXPECT_FALSE(together[0] == together[1]);  // checks that the comparison can fail
}

TEST(Batch, EachOfManyReplicasIsAsAlone) {
    Device device;
    Scene scene = small_scene({"protocol.scans_per_stroke=1", "plate.end=0.087"});
    std::vector<int> many(100, 0);
    many[57] = 1;
    const auto alone = bits_of_batch(device, scene, {1});
    EXPECT_TRUE(bits_of_batch(device, scene, many)[57] == alone[0]);
}

}  // namespace
}  // namespace mcdem
