// True diameters: the stated ones with a common error and an individual error.
#include "scene/packing/true_grains.h"

#include <numeric>

#include "scene_test_tools.h"

namespace mcdem {
namespace {

Packing stated(std::size_t count) {
    return {std::vector<Vec3>(count, Vec3::Zero()), std::vector<double>(count, 0.02)};
}

TEST(TrueGrains, AreAsStatedWithoutEffects) {
    EXPECT_EQ(true_packing(Replica{}, stated(5)).diameter, stated(5).diameter);
    EXPECT_EQ(excess_compliance(Replica{}, 3), std::vector<double>(3, 0.0));
}

TEST(TrueGrains, HaveACommonDiameterError) {
    Replica replica;
    replica.effects.diameter_error = -1e-3;
    for (const double diameter : true_packing(replica, stated(5)).diameter)
        EXPECT_NEAR(diameter, 0.019, 1e-15);
}

TEST(TrueGrains, HaveNormallyDistributedIndividualErrors) {
    constexpr double sd = 3e-4;
    constexpr int count = 2000;
    Replica replica;
    replica.effects.polydispersity = sd;
    replica.effects.diameter_error = 1e-4;
    const auto packing = true_packing(replica, stated(count));
    double sum = 0, squares = 0;
    for (const double diameter : packing.diameter) {
        sum += diameter - 0.02;
        squares += (diameter - 0.02) * (diameter - 0.02);
    }
    const double mean = sum / count;
    EXPECT_NEAR(mean, 1e-4, 4 * sd / std::sqrt(count));
    EXPECT_NEAR(std::sqrt(squares / count - mean * mean), sd, 4 * sd / std::sqrt(2.0 * count));
    EXPECT_EQ(packing.diameter, true_packing(replica, stated(count)).diameter) << "the same seed";
    replica.packing.seed = 2;
    EXPECT_NE(packing.diameter, true_packing(replica, stated(count)).diameter);
    EXPECT_EQ(packing.position.size(), count);
}

TEST(TrueGrains, MustHavePositiveDiameters) {
    Replica replica;
    replica.label = "too small";
    replica.effects.diameter_error = -0.02;
    EXPECT_THAT(
        problems_of([&] { true_packing(replica, stated(3)); }),
        testing::ElementsAre(
            "effects.diameter_error and effects.polydispersity must leave every diameter > 0 [m], got "
            "0 for grain 0 of too small"));
}

}  // namespace
}  // namespace mcdem
