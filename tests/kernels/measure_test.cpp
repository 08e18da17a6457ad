// Kernel reduce: sums over the grains of a replica, for various numbers of grains and portions.
#include "kernels/test_kernel.h"

namespace reference::measure {
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

mcdem::f32::Report reduced(const Grains& grains, const mcdem::Portion& portion) {
    struct Replicas;
    struct Portions;
    struct Partner;
    struct Force;
    struct Energy;
    struct Tracks;
    struct Status;
    struct Reports;
    mcdem::f32::Replica replica{};
    replica.grain_count = static_cast<int>(grains.status.size());
    mcdem::Field<Replicas> replicas(device(), 1, sizeof replica);
    mcdem::Field<Portions> portions(device(), 1, sizeof portion);
    mcdem::Field<Partner> partner(device(), grains.partner.size(), sizeof(int));
    mcdem::Field<Force> force(device(), grains.force.size(), sizeof(float));
    mcdem::Field<Energy> energy(device(), grains.status.size(), 8 * sizeof(float));
    mcdem::Field<Tracks> tracks(device(), grains.status.size(), 12 * sizeof(float));
    mcdem::Field<Status> status(device(), grains.status.size(), sizeof(int));
    mcdem::Field<Reports> reports(device(), 1, sizeof(mcdem::f32::Report));
    replicas.write(&replica);
    portions.write(&portion);
    partner.write(grains.partner.data());
    force.write(grains.force.data());
    energy.write(grains.energy.data());
    tracks.write(grains.track.data());
    status.write(grains.status.data());
    const cl::Program program = with_kernel("", build(Precision::single_precision));
    mcdem::Kernel<mcdem::Field<Replicas>, mcdem::Field<Portions>, mcdem::Field<Partner>, mcdem::Field<Force>,
                  mcdem::Field<Energy>, mcdem::Field<Tracks>, mcdem::Field<Status>, mcdem::Field<Reports>>(
        device(), program, "reduce", 64)(1, replicas, portions, partner, force, energy, tracks, status,
                                         reports);
    mcdem::f32::Report report;
    reports.read(&report);
    return report;
}

TEST(Reduce, SumsAndMaximaAreThoseOfAllGrains) {
    for (const int count : {1, 63, 64, 65, 500}) {
        SCOPED_TRACE(count);
        const Grains grains(count, 5);
        const auto report = reduced(grains, {0, 0});
        const KernelBuild kernels = build(Precision::single_precision);
        double kinetic = 0, elastic = 0, moved = 0, deepest = 0, fastest = 0, weight = 0, springs = 0;
        std::array<double, 4> works{};
        std::array<double, 18> walls{};
        for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
            kinetic += grains.energy[8 * i];
            elastic += grains.energy[8 * i + 1];
            moved = std::max<double>(moved, grains.energy[8 * i + 2]);
            deepest = std::max<double>(deepest, grains.energy[8 * i + 3]);
            weight += grains.energy[8 * i + 4];
            springs += grains.energy[8 * i + 5];
            fastest = std::max<double>(fastest, grains.energy[8 * i + 6]);
            for (std::size_t k = 0; k < 4; ++k) works[k] += grains.track[12 * i + 8 + k];
            for (std::size_t wall = 0; wall < 6; ++wall)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    walls[3 * wall + axis] -= grains.force[kernels.place_of_slot(i, wall, axis, 3)];
        }
        EXPECT_NEAR(report.kinetic_energy, kinetic, 1e-5 * kinetic);
        EXPECT_NEAR(report.elastic_energy, elastic, 1e-5 * elastic);
        EXPECT_EQ(report.moved_squared, static_cast<float>(moved));
        EXPECT_EQ(report.deepest_overlap, static_cast<float>(deepest));
        EXPECT_EQ(report.step_rate, static_cast<float>(fastest));
        EXPECT_NEAR(report.weight_work, weight, 1e-5 * weight);
        EXPECT_NEAR(report.spring_energy, springs, 1e-5 * springs);
        EXPECT_NEAR(report.work, works[0], 1e-5 * works[0]);
        EXPECT_NEAR(report.damped, works[1], 1e-5 * works[1]);
        EXPECT_NEAR(report.rubbed, works[2], 1e-5 * works[2]);
        EXPECT_NEAR(report.dragged, works[3], 1e-5 * works[3]);
        for (std::size_t q = 0; q < 18; ++q) EXPECT_NEAR(report.wall_force[q], walls[q], 1e-6 * count) << q;
        EXPECT_EQ(report.status, 0);
        EXPECT_EQ(report.failed_grain, -1);
    }
}

TEST(Reduce, ReportsTheFirstFailedGrainAndAllStatusBits) {
    Grains grains(300, 6);
    grains.status[250] = 1;
    grains.status[137] = 4;
    const auto report = reduced(grains, {0, 0});
    EXPECT_EQ(report.failed_grain, 137);
    EXPECT_EQ(report.status, 5);
}

}  // namespace
}  // namespace reference::measure
