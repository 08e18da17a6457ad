// Observed simulations of changed scenes: copies, stored results, new packings.
#include "ensemble/diagnosis/convergence_simulator.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstring>

#include "core/errors.h"
#include "ensemble/small_scene.h"

namespace mcdem {
namespace {

using testing::HasSubstr;

Scene pressed(const std::vector<std::string>& more, const std::string& tables = "") {
    std::vector<std::string> settings{"packing.count=18",        "packing.packing_fraction=0.52",
                                      "plate.start=0.06",        "plate.end=0.05",
                                      "protocol.relax_time=0.2", "protocol.stop_at_scans=false"};
    settings.insert(settings.end(), more.begin(), more.end());
    std::string text = small_scene_text;
    if (tables.find("[[programme]]") != tables.npos)
        text.erase(text.find("scans_per_stroke"), std::strlen("scans_per_stroke = 4\n"));
    return parse_scene(text + tables, "small.toml", settings);
}

struct ConvergenceSimulatorTest : testing::Test {
    ConvergenceSimulator simulator(const Scene& scene) const {
        ConvergenceSimulator made(scene, folder.path, 3, 0, 1, "test", "");
        made.find_grid({});
        return made;
    }
    std::size_t files() const {
        return std::distance(std::filesystem::recursive_directory_iterator(folder.path), {});
    }
    TestFolder folder;
};

bool equal_or_unknown(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    return ((a.array() == b.array()) || (a.array().isNaN() && b.array().isNaN())).all();
}

TEST_F(ConvergenceSimulatorTest, ChangesWhatIsAskedAndRepeatsNothing) {
    ConvergenceSimulator of_scene = simulator(pressed({"plate.speed=1"}));
    const Eigen::MatrixXd as_it_stands = of_scene.observe({}, {});
    EXPECT_EQ(as_it_stands.rows(), 3);
    EXPECT_FALSE(equal_or_unknown(as_it_stands.row(0), as_it_stands.row(1)))
        << "copies have their own jitter";
    EXPECT_TRUE(equal_or_unknown(of_scene.observe({{"plate.speed", "1"}}, {}), as_it_stands));
    const auto stored = files();
    EXPECT_FALSE(equal_or_unknown(of_scene.observe({{"plate.speed", "0.5"}}, {}), as_it_stands));
    EXPECT_GT(files(), stored);
    const auto after = files();
    ConvergenceSimulator again = simulator(pressed({"plate.speed=1"}));
    EXPECT_TRUE(equal_or_unknown(again.observe({}, {}), as_it_stands));
    EXPECT_EQ(files(), after);
}

TEST_F(ConvergenceSimulatorTest, DrawsOtherPackings) {
    ConvergenceSimulator of_scene = simulator(pressed({"plate.speed=2"}));
    ASSERT_TRUE(of_scene.draws_packings());
    const Eigen::MatrixXd copies = of_scene.observe({}, {});
    of_scene.draw_packings(never_stop);
    const Eigen::MatrixXd drawn = of_scene.observe({}, {});
    EXPECT_TRUE(equal_or_unknown(drawn.row(0), copies.row(0))) << "the first one has the scene's seed";
    EXPECT_FALSE(equal_or_unknown(drawn.row(1), copies.row(1)));
}

TEST_F(ConvergenceSimulatorTest, AProgrammeThatStopsIsReported) {
    EXPECT_THAT([&] { simulator(pressed({"plate.end=0.015"}, "[[programme]]\nposition = 0.015\n")); },
                testing::ThrowsMessage<InputError>(HasSubstr("does not come to the end of the programme")));
}

}  // namespace
}  // namespace mcdem
