#include "ensemble/make_packings.h"

#include <gmock/gmock.h>

#include "core/errors.h"
#include "ensemble/small_scene.h"
#include "scene/packing/make_packing.h"

namespace mcdem {
namespace {

TEST(MakePackings, GivesEveryReplicaItsOwn) {
    const Scene scene = small_scene({"batch.replicas=3", "packing.position_jitter=1e-5"});
    const auto packings = make_packings(scene);
    ASSERT_EQ(packings.size(), 6u);
    for (std::size_t r = 0; r < packings.size(); ++r) {
        const auto expected = make_packing(scene.replicas[r]);
        EXPECT_EQ(packings[r].diameter, expected.diameter) << r;
        ASSERT_EQ(packings[r].size(), expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i)
            EXPECT_EQ(packings[r].position[i], expected.position[i]) << r << " " << i;
    }
    EXPECT_NE(packings[0].diameter, packings[1].diameter);
}

TEST(MakePackings, ReportsAllProblemsAtOnce) {
    Scene scene = small_scene({"batch.replicas=2"});
    scene.replicas[0].packing.source = PackingFile{"nowhere.data"};
    scene.replicas[1].packing.source = PackingFile{"nowhere.data"};
    scene.replicas[3].packing.source = PackingFile{"nowhere.csv"};
    try {
        make_packings(scene);
        FAIL() << "missing files were not noticed";
    } catch (const InputError& error) {
        EXPECT_THAT(error.problems(), testing::ElementsAre(testing::HasSubstr("nowhere.data"),
                                                           testing::HasSubstr("nowhere.csv")));
    }
}

TEST(MakePackings, StopsOnRequest) {
    EXPECT_THROW(make_packings(small_scene(), [] { return true; }), Interrupted);
}

}  // namespace
}  // namespace mcdem
