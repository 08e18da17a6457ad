// Generated packings: sizes, positions, overlaps; the same bits for the same seed.
#include "scene/packing/generate_packing.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "core/near_pairs.h"
#include "core/random.h"
#include "largest_overlap.h"
#include "scene/packing/make_packing.h"
#include "scene/packing/overlap_relaxation.h"
#include "scene_test_tools.h"

namespace mcdem {
namespace {

const Box measured_box{0.165191, 0.165834};

GeneratedPacking wanted(int count, double packing_fraction) {
    GeneratedPacking packing;
    packing.count = count;
    packing.packing_fraction = packing_fraction;
    return packing;
}

/// A cubic box for this number of grains.
Box cube(int count, double packing_fraction) {
    const double edge =
        std::cbrt(count * std::numbers::pi / 6 / packing_fraction) * GeneratedPacking{}.diameter_mean;
    return {edge, edge};
}

double volume(const Packing& packing) {
    double sum = 0;
    for (double d : packing.diameter) sum += std::numbers::pi / 6 * d * d * d;
    return sum;
}

double height(const Packing& packing, const Box& box, double packing_fraction) {
    return volume(packing) / (packing_fraction * box.size_x * box.size_y);
}

TEST(CellPairs, AreFoundInAFlatBox) {
    const std::vector<Vec3> position{{500, 500, 5e-13}, {500.0001, 500, 5e-13}, {0, 1000, 0}};
    const NeighbourGrid grid(position, {1000, 1000}, 1e-12, 1e-3);
    std::set<std::pair<int, int>> pairs;
    grid.for_each_pair([&](int i, int j) { pairs.insert(std::minmax(i, j)); });
    EXPECT_TRUE(pairs.contains({0, 1}));
    EXPECT_FALSE(pairs.contains({0, 2}));
}

TEST(TruncatedNormal, QuantilesAgreeWithTables) {
    const TruncatedNormal wide{0, 1, -20, 20};
    EXPECT_NEAR(wide.quantile(0.5), 0, 1e-15);
    EXPECT_NEAR(wide.quantile(0.975), 1.959963984540054, 1e-12);
    EXPECT_NEAR(wide.quantile(0.001), -3.090232306167813, 1e-12);
    const TruncatedNormal half{0, 1, 0, 20};  // the median of the half-normal distribution
    EXPECT_NEAR(half.quantile(0.5), 0.674489750196082, 1e-12);
    const TruncatedNormal flat{0, 1e6, -1, 1};  // nearly uniform
    EXPECT_NEAR(flat.quantile(0.25), -0.5, 1e-9);
    EXPECT_EQ((TruncatedNormal{3, 0, 1, 5}.quantile(0.9)), 3);
    EXPECT_EQ((TruncatedNormal{3, 2, 3, 3}.quantile(0.9)), 3);
}

TEST(Random, HasTheExpectedMoments) {
    Random random(3, Stream::jitter);
    const int n = 100000;
    double mean = 0, square = 0, fourth = 0, uniform = 0;
    for (int i = 0; i < n; ++i) {
        const double x = random.normal();
        mean += x / n;
        square += x * x / n;
        fourth += x * x * x * x / n;
        uniform += random.uniform() / n;
    }
    EXPECT_NEAR(mean, 0, 5 / std::sqrt(n));
    EXPECT_NEAR(square, 1, 5 * std::sqrt(2.0 / n));
    EXPECT_NEAR(fourth, 3, 5 * std::sqrt(96.0 / n));
    EXPECT_NEAR(uniform, 0.5, 5 * std::sqrt(1 / 12.0 / n));
}

TEST(Random, IsTheSameOnEveryMachine) {
    Random random(1, Stream::diameters);
    EXPECT_EQ(random.uniform(), 0.7166913209529362);  // from an independent program
    EXPECT_NE(Random(1, Stream::positions).uniform(), Random(1, Stream::diameters).uniform());
    EXPECT_NE(Random(1, Stream::diameters).uniform(), Random(2, Stream::diameters).uniform());
}

TEST(GeneratedPacking, HasTheSizeDistributionOfTheExperiment) {
    const Packing packing = generate_packing(wanted(514, 0.59), measured_box, 1);
    ASSERT_EQ(packing.size(), 514u);
    double mean = 0, square = 0;
    for (double d : packing.diameter) {
        EXPECT_GE(d, 18.167e-3);
        EXPECT_LE(d, 24.561e-3);
        mean += d / 514;
    }
    for (double d : packing.diameter) square += (d - mean) * (d - mean) / 513;
    EXPECT_NEAR(mean, 21.490e-3, 0.02e-3);
    EXPECT_NEAR(std::sqrt(square), 1.199e-3, 0.06e-3) << "the cut takes 4 %";
    EXPECT_NEAR(volume(packing), 2695.88e-6, 0.003 * 2695.88e-6);
    EXPECT_FALSE(std::is_sorted(packing.diameter.begin(), packing.diameter.end())) << "sizes are mixed";
    EXPECT_NEAR(height(packing, measured_box, 0.59), expected_height(wanted(514, 0.59), measured_box),
                0.1e-3);
}

TEST(GeneratedPacking, VolumeHardlyDependsOnTheSeed) {
    const double first = volume(generate_packing(wanted(514, 0.4), measured_box, 1));
    for (std::uint64_t seed : {2, 3, 4})
        EXPECT_NEAR(volume(generate_packing(wanted(514, 0.4), measured_box, seed)) / first, 1, 5e-4);
}

TEST(GeneratedPacking, SameSeedSameBits) {
    const Packing a = generate_packing(wanted(100, 0.55), cube(100, 0.55), 9);
    const Packing b = generate_packing(wanted(100, 0.55), cube(100, 0.55), 9);
    const Packing c = generate_packing(wanted(100, 0.55), cube(100, 0.55), 10);
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.diameter, b.diameter);
    EXPECT_NE(a.position, c.position);
}

TEST(GeneratedPacking, SpheresDoNotOverlapIfThereIsRoom) {
    for (const auto& [count, fraction] : {std::pair{514, 0.55}, {60, 0.45}, {4000, 0.58}}) {
        const Box box = cube(count, fraction);
        const Packing packing = generate_packing(wanted(count, fraction), box, 4);
        EXPECT_LT(largest_overlap(packing, box, height(packing, box, fraction)), 0.01)
            << count << " at " << fraction;
    }
}

TEST(GeneratedPacking, CompressedPackingsAreBalanced) {
    // At higher packing fractions overlaps are distributed: most grains touch several others, and none is
    // inside another.
    const Packing packing = generate_packing(wanted(514, 0.72), measured_box, 5);
    const double top = height(packing, measured_box, 0.72);
    EXPECT_LT(largest_overlap(packing, measured_box, top), 0.5);
    EXPECT_GT(largest_overlap(packing, measured_box, top), 0.05);
    for (const Vec3& p : packing.position) {
        EXPECT_GT(p.minCoeff(), 0);
        EXPECT_LT(p.x(), measured_box.size_x);
        EXPECT_LT(p.y(), measured_box.size_y);
        EXPECT_LT(p.z(), top);
    }
}

TEST(GeneratedPacking, OneGrainAndAVeryLargeBox) {
    const Box box{0.05, 0.05};
    const Packing one = generate_packing(wanted(1, 0.08), box, 1);
    EXPECT_EQ(largest_overlap(one, box, height(one, box, 0.08)), 0);
    const Box desert{100, 100};
    const Packing few = generate_packing(wanted(3, 1e-8), desert, 1);
    EXPECT_EQ(few.size(), 3u);
}

TEST(OverlapRelaxation, TwoGrainsSeparateAlongTheirLineOfCentres) {
    const Box box{0.1, 0.1};
    const Packing packing{{{0.05, 0.05, 0.046}, {0.05, 0.05, 0.054}}, {0.02, 0.02}};
    EXPECT_NEAR(largest_overlap(packing, box, 0.1), 1.2, 1e-12);
    OverlapRelaxation relaxation(packing, box, 0.1);
    relaxation.relax(1, 1000);
    const Vec3 apart = relaxation.position()[1] - relaxation.position()[0];
    EXPECT_GT(apart.z(), 0.01989);
    EXPECT_NEAR(apart.x(), 0, 1e-12);
    EXPECT_NEAR((relaxation.position()[1] + relaxation.position()[0]).z(), 0.1, 1e-12)
        << "the centre of mass stays";
}

TEST(OverlapRelaxation, StackBetweenFloorAndLidSharesTheOverlapEqually) {
    // Three grains of 20 mm in a height of 54 mm: four contacts share 6 mm, 1.5 mm each.
    const Box box{0.02, 0.02};
    const Packing packing{{{0.01, 0.01, 0.009}, {0.01, 0.01, 0.030}, {0.01, 0.01, 0.044}},
                          {0.02, 0.02, 0.02}};
    OverlapRelaxation relaxation(packing, box, 0.054);
    relaxation.relax(1, 5000);
    EXPECT_NEAR(relaxation.position()[0].z(), 0.0085, 5e-5);
    EXPECT_NEAR(relaxation.position()[1].z(), 0.0270, 5e-5);
    EXPECT_NEAR(relaxation.position()[2].z(), 0.0455, 5e-5);
}

TEST(LargestOverlap, IncludesWallsAndPairsOfUnequalGrains) {
    const Box box{0.1, 0.1};
    EXPECT_NEAR(largest_overlap({{{0.05, 0.008, 0.05}}, {0.02}}, box, 0.1), 0.2, 1e-12);
    EXPECT_NEAR(largest_overlap({{{0.05, 0.05, 0.095}}, {0.02}}, box, 0.1), 0.5, 1e-12) << "the lid";
    EXPECT_NEAR(largest_overlap({{{0.03, 0.05, 0.05}, {0.044, 0.05, 0.05}}, {0.02, 0.01}}, box, 0.1), 0.2,
                1e-12)
        << "1 mm of 5 mm";
}

TEST(Jitter, HasTheStatedSize) {
    Packing packing;
    packing.position.assign(20000, Vec3(1, 2, 3));
    packing.diameter.assign(20000, 0.02);
    Packing same = packing, other = packing;
    apply_jitter(packing, 2e-5, 7);
    apply_jitter(same, 2e-5, 7);
    apply_jitter(other, 2e-5, 8);
    EXPECT_EQ(packing.position, same.position);
    EXPECT_NE(packing.position, other.position);
    double square = 0;
    for (const Vec3& p : packing.position) square += (p - Vec3(1, 2, 3)).squaredNorm() / 60000;
    EXPECT_NEAR(std::sqrt(square), 2e-5, 5 * 2e-5 / std::sqrt(120000));
}

TEST(MakePacking, ReadsOrGeneratesThenJitters) {
    Replica replica;
    replica.packing.source = wanted(100, 0.5);
    replica.packing.seed = 3;
    const Packing plain = make_packing(replica);
    EXPECT_EQ(plain.position, generate_packing(wanted(100, 0.5), replica.box, 3).position);
    replica.packing.position_jitter = 1e-5;
    const Packing moved = make_packing(replica);
    EXPECT_NE(moved.position, plain.position);
    EXPECT_NEAR(moved.position[50].x(), plain.position[50].x(), 6e-5);

    const TestFolder folder;
    replica.packing.source =
        PackingFile{folder.write("one.csv", "x_m,y_m,z_m,diameter_m\n0.05,0.05,0.05,0.02\n").string()};
    EXPECT_EQ(make_packing(replica).size(), 1u);
    replica.plate.start = 0.04;
    EXPECT_THAT(problems_of([&] { make_packing(replica); }),
                testing::ElementsAre(testing::HasSubstr("below the plate at 0.04 m")));
}

}  // namespace
}  // namespace mcdem
