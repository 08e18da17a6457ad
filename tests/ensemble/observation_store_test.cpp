// Stored observations are found again; other, damaged and foreign files are not used.
#include "ensemble/diagnosis/observation_store.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/errors.h"
#include "ensemble/small_scene.h"

namespace mcdem {
namespace {

struct Store {
    TestFolder folder;
    ObservationStore store{folder.path / "made" / "on demand"};
    std::filesystem::path file(const std::string& name) const {
        return folder.path / "made" / "on demand" / name;
    }
};

TEST(ObservationStore, FindsStoredObservations) {
    const Store s;
    const Eigen::VectorXd kept = Eigen::Vector4d(1.0 / 3, unknown, -INFINITY, 1e-300);
    EXPECT_FALSE(s.store.find("name"));
    s.store.keep("name", kept);
    const auto found = s.store.find("name");
    ASSERT_TRUE(found);
    ASSERT_EQ(found->size(), 4);
    for (const Eigen::Index k : {0, 2, 3}) EXPECT_EQ((*found)[k], kept[k]);
    EXPECT_TRUE(std::isnan((*found)[1]));
    EXPECT_FALSE(s.store.find("another"));
    s.store.keep("name", Eigen::VectorXd(Eigen::Vector2d(7, 8)));
    EXPECT_EQ(*s.store.find("name"), Eigen::Vector2d(7, 8));
    EXPECT_EQ(*ObservationStore(s.file("")).find("name"), Eigen::Vector2d(7, 8));
}

TEST(ObservationStore, IgnoresDamagedFiles) {
    const Store s;
    s.store.keep("name", Eigen::VectorXd(Eigen::Vector3d(1, 2, 3)));
    const auto file = s.file("name.obs");
    const std::string whole = bytes_of_file(file);
    const auto replace = [&](const std::string& bytes) { std::ofstream(file, std::ios::binary) << bytes; };
    for (std::size_t at = 0; at < whole.size(); at += 5) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 1);
        replace(damaged);
        EXPECT_FALSE(s.store.find("name")) << at;
    }
    for (const std::size_t length : {std::size_t{0}, std::size_t{10}, whole.size() - 8, whole.size() - 3}) {
        replace(whole.substr(0, length));
        EXPECT_FALSE(s.store.find("name")) << length;
    }
    replace(whole);
    EXPECT_TRUE(s.store.find("name"));
}

TEST(ObservationStore, StoresRecordings) {
    const Store s;
    Recording recording;
    recording.label = "seen";
    recording.box = {0.1, 0.2};
    recording.plate_start = 0.3;
    recording.diameter = {0.02, 0.021};
    recording.scans.resize(2);
    recording.scans[1].plate_z = 0.25;
    EXPECT_FALSE(s.store.has_recording("name"));
    EXPECT_THROW(s.store.recording("name"), InputError);
    s.store.keep("name", recording);
    EXPECT_TRUE(s.store.has_recording("name"));
    EXPECT_FALSE(s.store.find("name"));  // an observation of that name is separate
    const Recording back = s.store.recording("name");
    EXPECT_EQ(back.label, "seen");
    EXPECT_EQ(back.plate_start, 0.3);
    ASSERT_EQ(back.scans.size(), 2u);
    EXPECT_EQ(back.scans[1].plate_z, 0.25);
    std::ofstream(s.file("name.h5"), std::ios::binary) << "no longer";
    EXPECT_THROW(s.store.recording("name"), InputError);
    EXPECT_FALSE(s.store.has_recording("name"));  // and is computed again
}

}  // namespace
}  // namespace mcdem
