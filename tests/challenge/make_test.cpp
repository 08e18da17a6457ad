// Simulated experiments that run away are weakened before they are sealed; sealed ones survive an
// interruption.
#include "challenge/make.h"

#include <gmock/gmock.h>

#include <cmath>

#include "challenge/case_simulator.h"
#include "challenge/truth.h"
#include "core/errors.h"
#include "ensemble/small_scene.h"

namespace mcdem {
namespace {

namespace fs = std::filesystem;

/// 27 grains, very dense at the end: strongly interacting contacts have no static solution there.
Scene dense_scene() {
    return parse_scene(R"(name = "dense"
[box]
size_x = 0.062
size_y = 0.062
[contact]
model = "independent"
[packing]
count = 27
packing_fraction = 0.59
[plate]
start = 0.0625
end = 0.0490
speed = 0.3
[protocol]
stop_at_scans = false
scans_per_stroke = 3
relax_time = 0.05
)",
                       "dense.toml");
}

ChallengeOptions options_for(const fs::path& folder) {
    ChallengeOptions options;
    options.folder = folder / "challenge";
    options.truth = folder / "truth.json";
    options.seed = 1;
    options.size = {1, 2, 2, 0, 0, 2};
    options.effects = {"cross_contact", "stiffening"};
    return options;
}

Challenge drawn(Device& device, const ChallengeOptions& options) {
    const Scene scene = dense_scene();
    const CaseSimulator simulator(device, scene, options.measurement);
    return draw_challenge(options.size, options.effects, simulator.stated(), simulator.nuisances(),
                          seal_of(scene.text), *options.seed);
}

TEST(MakeChallenge, WeakensRunAwayExperimentsBeforeSealing) {
    TestFolder folder;
    Device device;
    const ChallengeOptions options = options_for(folder.path);
    const std::string seal = make_challenge(device, dense_scene(), options);
    const Challenge wanted = drawn(device, options), sealed = open_truth(options.truth, seal);
    int weakened = 0;
    for (std::size_t k = 0; k < wanted.cases.size(); ++k) {
        EXPECT_TRUE(fs::exists(options.folder / wanted.cases[k].folder / "experiment.toml"));
        ASSERT_EQ(sealed.cases[k].effects.size(), wanted.cases[k].effects.size());
        for (std::size_t e = 0; e < wanted.cases[k].effects.size(); ++e) {
            const double part = sealed.cases[k].effects[e].amplitude / wanted.cases[k].effects[e].amplitude;
            const double tries = std::log(part) / std::log(0.8);
            EXPECT_NEAR(tries, std::round(tries), 1e-9);
            weakened += part < 0.9;
        }
    }
    EXPECT_GT(weakened, 0);
    EXPECT_LT(weakened, 8);
    EXPECT_EQ(make_challenge(device, dense_scene(), options), seal) << "what is sealed stays";
}

TEST(MakeChallenge, ContinuesAfterAnInterruption) {
    TestFolder folder;
    Device device;
    ChallengeOptions options = options_for(folder.path);
    const std::string seal = make_challenge(device, dense_scene(), options);
    options.folder = folder.path / "again";
    options.truth = folder.path / "again.json";
    bool sealed_early = false;
    options.stop_wanted = [&] {
        sealed_early = fs::exists(options.truth);
        return true;
    };
    EXPECT_THROW(make_challenge(device, dense_scene(), options), Interrupted);
    EXPECT_FALSE(sealed_early);
    options.stop_wanted = [&] { return fs::exists(options.folder / "challenge.json"); };
    EXPECT_THROW(make_challenge(device, dense_scene(), options), Interrupted);
    EXPECT_TRUE(fs::exists(options.truth));
    EXPECT_FALSE(fs::exists(options.folder / "case_0001"));
    options.stop_wanted = [] { return false; };
    double last = 0;
    options.on_progress = [&](double fraction) {
        EXPECT_GE(fraction, last);
        EXPECT_LE(fraction, 1);
        last = fraction;
    };
    EXPECT_EQ(make_challenge(device, dense_scene(), options), seal);
    EXPECT_EQ(bytes_of_file(options.folder / "case_0001/contacts.csv.gz"),
              bytes_of_file(folder.path / "challenge/case_0001/contacts.csv.gz"));
    EXPECT_GT(last, 0.9);
}

TEST(MakeChallenge, WithoutASeedItIsRandomAndSecret) {
    TestFolder folder;
    Device device;
    ChallengeOptions options = options_for(folder.path);
    options.size = {1, 0, 0, 0, 0, 2};
    options.seed.reset();
    const std::string seal = make_challenge(device, dense_scene(), options);
    EXPECT_EQ(make_challenge(device, dense_scene(), options), seal);
    options.folder = folder.path / "other";
    options.truth = folder.path / "other.json";
    EXPECT_NE(make_challenge(device, dense_scene(), options), seal);
}

}  // namespace
}  // namespace mcdem
