// Runs with containers of several shapes in one batch.
#include "core/container.h"
#include "ensemble/make_packings.h"
#include "ensemble/run_scene.h"
#include "ensemble/small_scene.h"
#include "io/results.h"

namespace mcdem {
namespace {

const char* const three_shapes = R"(
[container]
size_x = 0.08
size_y = 0.08
radius = 0.04
[packing]
count = 30
packing_fraction = 0.5
[plate]
start = 0.07
end = 0.06
[protocol]
scans_per_stroke = 2
settle_time = 0.001
relax_time = 0.001
[batch.vary]
"container.shape" = ["box", "cylinder", "periodic"]
)";

TEST(Containers, OfSeveralShapesRunInOneBatchAndAreReadBack) {
    TestFolder folder;
    Device device;
    RunOptions options;
    options.folder = folder.path / "run";
    const Scene scene = parse_scene(three_shapes, "three.toml", {});
    EXPECT_EQ(run_scene(device, scene, options).end, RunEnd::done);
    const auto run = read_run(options.folder, ReadWhat::everything);
    ASSERT_EQ(run.recordings.size(), 3u);
    for (std::size_t r = 0; r < 3; ++r) {
        const Recording& recording = run.recordings[r];
        EXPECT_EQ(recording.box.shape, static_cast<ContainerShape>(r));
        EXPECT_FALSE(recording.failure);
        ASSERT_EQ(recording.scans.size(), 4u);
        for (const Scan& scan : recording.scans)
            for (const Contact& contact : scan.contacts)
                EXPECT_TRUE(!is_wall(contact.partner) || has_wall(recording.box, wall_of(contact.partner)));
    }
    EXPECT_NE(run.recordings[0].scans[0].position, run.recordings[2].scans[0].position);
}

TEST(Containers, WithEqualSizesHaveDifferentPackings) {
    const auto packings = make_packings(parse_scene(three_shapes, "three.toml", {}));
    ASSERT_EQ(packings.size(), 3u);
    EXPECT_NE(packings[0].position, packings[1].position);
    EXPECT_NE(packings[0].position, packings[2].position);
}

}  // namespace
}  // namespace mcdem
