// Convergence of a small scene: a slow plate is converged, a fast one is not, and the plate's speed is named
// as the cause.
#include "ensemble/converge_scene.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <set>

#include "core/errors.h"
#include "ensemble/small_scene.h"

namespace mcdem {
namespace {

using testing::HasSubstr;

Scene pressed(const std::vector<std::string>& more, const std::string& programme = "") {
    std::vector<std::string> settings{"packing.count=18",        "packing.packing_fraction=0.52",
                                      "plate.start=0.06",        "plate.end=0.05",
                                      "protocol.relax_time=0.2", "protocol.stop_at_scans=false"};
    settings.insert(settings.end(), more.begin(), more.end());
    std::string text = small_scene_text;
    if (!programme.empty()) text.erase(text.find("scans_per_stroke"), std::strlen("scans_per_stroke = 4\n"));
    return parse_scene(text + programme, "small.toml", settings);
}

struct ConvergeScene : testing::Test {
    Convergence converge(const Scene& scene, const std::string& name = "out") {
        ConvergeOptions options;
        options.folder = folder.path / name;
        options.replicas = 8;
        options.on_progress = [&](const std::string& cause, double) { causes.insert(cause); };
        Device device;
        return converge_scene(device, scene, options);
    }
    const CauseErrors& of(const Convergence& convergence, const std::string& cause) {
        return *std::ranges::find(convergence.causes, cause, &CauseErrors::cause);
    }
    TestFolder folder;
    std::set<std::string> causes;
};

// At 2 m/s the inertial number is 0.3.
TEST_F(ConvergeScene, NamesAFastPlateAsTheCause) {
    const Convergence fast = converge(pressed({"plate.speed=2"}));
    EXPECT_GE(fast.worst_beyond(of(fast, "plate speed")), 0);
    EXPECT_GE(fast.worst_beyond(of(fast, "inertia")), 0);
    EXPECT_LT(fast.worst_beyond(of(fast, "precision")), 0);
    EXPECT_THAT(causes,
                testing::IsSupersetOf({"plate speed", "inertia", "time step", "precision", "list margin"}));
    EXPECT_THAT(of(fast, "plate speed").remedy, HasSubstr("plate.speed = 2"));
}

std::string programme_at(double speed) {
    return fmt::format(R"(
[[programme]]
position = 0.046
speed = {0}
scans = 6
[[programme]]
stage = "hold"
time = 0.1
scans = 2
[[programme]]
position = 0.06
speed = {0}
scans = 6
)",
                       speed);
}

// The speeds of a programme's stages are refined, and the observables of holds are compared.
TEST_F(ConvergeScene, RefinesAProgramme) {
    const Convergence fast = converge(pressed({"plate.end=0.046"}, programme_at(1)));
    EXPECT_GE(fast.worst_beyond(of(fast, "plate speed")), 0);
    EXPECT_THAT(of(fast, "plate speed").remedy, HasSubstr("speeds of stages"));
    EXPECT_THAT(causes, testing::Contains("the programme's displacements"));
    const auto relaxation = static_cast<int>(index_of(OfProgramme::relaxation));
    const int worst = fast.worst_cell(of(fast, "plate speed"), relaxation);
    ASSERT_GE(worst, 0);
    const CellError error = of(fast, "plate speed").cells[static_cast<std::size_t>(worst)];
    EXPECT_GT(error.value, 2 * error.standard_error)
        << "grains at rest relax less than those that a plate has thrown";
    EXPECT_GT(fast.mean[worst], error.value);
}

TEST_F(ConvergeScene, AProgrammeThatStopsIsReportedAtOnce) {
    try {
        converge(pressed({"plate.end=0.015"}, "[[programme]]\nposition = 0.015\n"));
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("does not come to the end of the programme"));
    }
}

// One grain between floor and plate: the force does not depend on its position, so copies have no scatter.
TEST_F(ConvergeScene, DrawsNewPackingsIfCopiesHardlyDiffer) {
    const std::vector<std::string> one_grain{"packing.count=1",
                                             "packing.packing_fraction=0.382",
                                             "box.size_x=0.025",
                                             "box.size_y=0.025",
                                             "packing.diameter_mean=0.0215",
                                             "packing.diameter_sd=1e-4",
                                             "packing.diameter_min=0.0213",
                                             "packing.diameter_max=0.0217",
                                             "plate.start=0.022",
                                             "plate.end=0.0195",
                                             "plate.speed=0.5"};
    const Convergence drawn = converge(pressed(one_grain), "drawn");
    EXPECT_THAT(drawn.copies, HasSubstr("new random packings"));
    EXPECT_GT(drawn.deviation[0], 0.01) << "diameters differ";
    EXPECT_TRUE(causes.contains("new random packings"));
    EXPECT_THAT(of(drawn, "plate speed").remedy, HasSubstr("times as long"));
}

// Stored simulations are not repeated and give the same result.
TEST_F(ConvergeScene, ReusesStoredSimulations) {
    const Scene scene = pressed({"plate.speed=0.5"});
    const Convergence first = converge(scene);
    const auto files = std::distance(std::filesystem::recursive_directory_iterator(folder.path), {});
    const Convergence second = converge(scene);
    EXPECT_EQ(std::distance(std::filesystem::recursive_directory_iterator(folder.path), {}), files);
    for (std::size_t k = 0; k < first.causes.size(); ++k)
        for (std::size_t c = 0; c < first.cells.size(); ++c)
            if (!std::isnan(first.causes[k].cells[c].value)) {
                EXPECT_EQ(first.causes[k].cells[c].value, second.causes[k].cells[c].value);
            }
}

TEST_F(ConvergeScene, APlateThatNeverTouchesIsReportedAtOnce) {
    try {
        converge(pressed({"plate.start=0.2", "plate.end=0.19"}));
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("replicas reach the first compared displacement"));
    }
    EXPECT_THAT(causes, testing::ElementsAre("the scene as it stands"));
}

}  // namespace
}  // namespace mcdem
