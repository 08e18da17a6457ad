// Kernel reduce: sums over the grains of a replica, for various numbers of grains and portions.
#include "kernels/test_kernel.h"

namespace mcdem::reference::measure {
namespace {

constexpr int slots = 16;

struct Grains {
    explicit Grains(int count, unsigned seed) : status(static_cast<std::size_t>(count), 0) {
        Uniform uniform(seed);
        const KernelBuild kernels = build(Precision::single_precision);
        const std::size_t rows = static_cast<std::size_t>((count + 15) / 16 * 16 * slots);
        partner.assign(rows, NO_PARTNER);
        force.assign(3 * rows, 0);
        for (int i = 0; i < count; ++i) {
            for (int k = 0; k < 8; ++k) energy.push_back(static_cast<float>(uniform(0, 1)));
            for (int k = 0; k < 12; ++k) track.push_back(static_cast<float>(uniform(0, 1)));
            for (int slot = 0; slot < slots; ++slot) {
                const std::size_t place = kernels.place_of_slot(i, slot);
                partner[place] = slot < 6 ? WALL_PARTNER(slot) : slot < 9 ? i / 2 : NO_PARTNER;
                for (std::size_t axis = 0; axis < 3; ++axis)
                    force[kernels.place_of_slot(i, slot, axis, 3)] = static_cast<float>(uniform(-1, 1));
            }
        }
    }
    std::vector<float> energy, track, force;
    std::vector<int> partner, status;
};

mcdem::f32::Report reduced(const Grains& grains) {
    mcdem::f32::Replica replica{};
    replica.grain_count = static_cast<int>(grains.status.size());
    const Buffer reports = room_for<mcdem::f32::Report>(1);
    launch(with_kernel("", build(Precision::single_precision)), "reduce", 64, 1, uploaded(replica),
           uploaded(mcdem::Portion{0, 0}), uploaded(grains.partner), uploaded(grains.force),
           uploaded(grains.energy), uploaded(grains.track), uploaded(grains.status), reports);
    return downloaded<mcdem::f32::Report>(reports).front();
}

TEST(Reduce, SumsAndMaximaAreThoseOfAllGrains) {
    for (const int count : {1, 63, 64, 65, 500}) {
        SCOPED_TRACE(count);
        const Grains grains(count, 5);
        const auto report = reduced(grains);
        const KernelBuild kernels = build(Precision::single_precision);
        std::array<double, 8> sum{}, largest{};  // of the numbers of a grain's energies
        std::array<double, 4> works{};
        std::array<double, 18> walls{};
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
            for (std::size_t k = 0; k < 8; ++k) {
                sum[k] += grains.energy[8 * i + k];
                largest[k] = std::max<double>(largest[k], grains.energy[8 * i + k]);
            }
            for (std::size_t k = 0; k < 4; ++k) works[k] += grains.track[12 * i + 8 + k];
            for (std::size_t wall = 0; wall < 6; ++wall)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    walls[3 * wall + axis] -= grains.force[kernels.place_of_slot(i, wall, axis, 3)];
        }
        EXPECT_EQ(report.moved_squared, static_cast<float>(largest[2]));
        EXPECT_EQ(report.deepest_overlap, static_cast<float>(largest[3]));
        EXPECT_EQ(report.step_rate, static_cast<float>(largest[6]));
        for (const auto& [found, expected] : {std::pair(report.kinetic_energy, sum[0]),
                                              {report.elastic_energy, sum[1]},
                                              {report.weight_work, sum[4]},
                                              {report.spring_energy, sum[5]},
                                              {report.work, works[0]},
                                              {report.damped, works[1]},
                                              {report.rubbed, works[2]},
                                              {report.dragged, works[3]}})
            EXPECT_NEAR(found, expected, 1e-5 * expected);
        for (std::size_t q = 0; q < 18; ++q) EXPECT_NEAR(report.wall_force[q], walls[q], 1e-6 * count) << q;
        EXPECT_EQ(report.status, 0);
        EXPECT_EQ(report.failed_grain, -1);
    }
}

TEST(Reduce, ReportsTheFirstFailedGrainAndAllStatusBits) {
    Grains grains(300, 6);
    grains.status[250] = grains.status[137 + 64] = 1;  // the second in the same work-item
    grains.status[137] = 4;
    const auto report = reduced(grains);
    EXPECT_EQ(report.failed_grain, 137);
    EXPECT_EQ(report.status, 5);
}

}  // namespace
}  // namespace mcdem::reference::measure
