// Energy of grains without friction and damping. Hertz's law alone conserves it to the order of the
// integrator. With surface displacements the phase error of the extrapolation adds or removes energy; it is
// measured over 50 oscillations, for every model and three time steps.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/names.h"
#include "reference/test_scene.h"

namespace mcdem::reference {
namespace {

constexpr double time_steps[] = {0.04, 0.02, 0.01};
constexpr int oscillations = 50;
constexpr double rounding = 1e-5;  ///< of the mean energy over some oscillations

/// Kinetic energy has two maxima per oscillation.
constexpr int peaks_wanted = 2 * oscillations + 1;

Start ringing_cluster(ContactModel model, double time_step) {
    Replica replica = test_replica(model);
    replica.grains = {23.3e3, 0.45, 1000, 0, 0, 1, 0};
    replica.walls = {1e12, 0.45, 0, 1};
    replica.contact.gamma = 1.125;
    replica.numerics.time_step = time_step;
    return caged_cluster(replica, 0.03, 1e-4, 3);
}

/// Energies of one replica at each step.
class Record {
public:
    void add(double kinetic, double elastic) {
        kinetic_.push_back(kinetic);
        elastic_.push_back(elastic);
        const std::size_t n = kinetic_.size();
        max_ = std::max(max_, kinetic);
        if (n >= 3 && kinetic_[n - 2] > kinetic && kinetic_[n - 2] >= kinetic_[n - 3] &&
            kinetic_[n - 2] > 0.1 * max_)
            peaks_.push_back(n - 2);
    }
    bool done() const { return peaks_.size() >= peaks_wanted; }
    double steps_per_oscillation() const {
        return 2.0 * (peaks_.back() - peaks_.front()) / (peaks_.size() - 1);
    }
    /// Mean total energy between two maxima.
    double energy(int first_peak, int last_peak) const {
        double sum = 0;
        for (std::size_t i = peaks_[first_peak]; i < peaks_[last_peak]; ++i) sum += elastic_[i] + kinetic_[i];
        return sum / (peaks_[last_peak] - peaks_[first_peak]);
    }
    /// Drift per oscillation, relative to the largest kinetic energy, from the means over the first and the
    /// last ten oscillations.
    double drift() const {
        const int last = peaks_.size() - 1;
        return (energy(last - 20, last - 1) - energy(0, 19)) / max_ / (oscillations - 10);
    }

private:
    std::vector<double> kinetic_, elastic_;
    std::vector<std::size_t> peaks_;
    double max_ = 0;
};

std::vector<Record> ring(const std::vector<Start>& starts) {
    Batch batch(build(Precision::double_precision), starts);
    for (std::size_t r = 0; r < starts.size(); ++r) batch.engine().keep_time_step(static_cast<int>(r));
    std::vector<Record> records(starts.size());
    for (bool any = true; any;) {
        std::vector<mcdem::StepInterval> intervals;
        any = false;
        for (std::size_t r = 0; r < starts.size(); ++r) {
            intervals.push_back({records[r].done() ? 0 : 1, starts[r].replica.plate.start, 0, 0});
            any |= intervals.back().steps > 0;
        }
        const auto results = batch.engine().advance(intervals);
        for (std::size_t r = 0; r < starts.size(); ++r) {
            EXPECT_EQ(results[r].status, 0);
            if (results[r].status) return {};
            if (intervals[r].steps) records[r].add(results[r].kinetic_energy, results[r].elastic_energy);
        }
    }
    return records;
}

/// The phase error of the extrapolation (10 b(t) - 5 b(t - 2 dt) + b(t - 4 dt)) / 6 is 8/3 sin^5(omega dt).
/// If surface displacements contribute a part g of the stiffness, the energy changes by 2 pi g times this
/// per oscillation. For |g| > 1 there is no stable state.
double drift_bound(double steps_per_oscillation) {
    using std::numbers::pi;
    return 2 * pi * 8.0 / 3 * std::pow(std::sin(2 * pi / steps_per_oscillation), 5);
}

TEST(Energy, DriftsLessThanTheExtrapolationAllows) {
    if (!has_double()) GTEST_SKIP() << "the device has no double precision";
    std::vector<Start> starts;
    for (ContactModel model : all_models)
        for (double time_step : time_steps) starts.push_back(ringing_cluster(model, time_step));
    const auto records = ring(starts);
    ASSERT_EQ(records.size(), starts.size());
    fmt::print("drift of the energy of motion per oscillation, over {} oscillations of 13 caged grains\n",
               oscillations);
    fmt::print("{:22} {:>9} {:>18} {:>10} {:>10}\n", "model", "time step", "steps/oscillation", "drift",
               "bound");
    for (std::size_t m = 0; m < std::size(all_models); ++m) {
        for (std::size_t t = 0; t < 3; ++t) {
            const Record& record = records[3 * m + t];
            const double steps = record.steps_per_oscillation();
            fmt::print("{:22} {:>9} {:>18.1f} {:>10.1e} {:>10.1e}\n", name(all_models[m]), time_steps[t],
                       steps, record.drift(), drift_bound(steps));
            EXPECT_LT(std::abs(record.drift()), drift_bound(steps) + rounding)
                << name(all_models[m]) << ' ' << time_steps[t];
            EXPECT_TRUE(all_models[m] != ContactModel::independent || std::abs(record.drift()) < 2e-5);
        }
        // fifth order gives factors of 32 and 1024; half of that is required, since modes are mixed
        if (all_models[m] == ContactModel::independent) continue;
        EXPECT_LT(std::abs(records[3 * m + 1].drift()), std::abs(records[3 * m].drift()) / 16 + rounding)
            << name(all_models[m]);
        EXPECT_LT(std::abs(records[3 * m + 2].drift()), 5e-5) << name(all_models[m]);
    }
}

// A pair without adhesion collides and separates: all the energy is returned.
TEST(Energy, ElasticCollisionReturnsAllEnergy) {
    Replica replica = test_replica(ContactModel::mc_dem);
    replica.grains = {1e5, 0.3, 1000, 0, 0, 1, 0};
    for (double time_step : time_steps) {
        replica.numerics.time_step = time_step;
        const Start start = free_cluster(replica, {{0, 0, 0}, {0.0201, 0, 0}}, {0.02, 0.02});
        Batch batch(build(finest()), start);
        batch.engine().set_velocities(0, {{0.05, 0, 0}, {0, 0, 0}}, std::vector<Vec3>(2, Vec3::Zero()));
        const double before = batch.advance(1).front().kinetic_energy;
        double highest = 0;
        mcdem::IntervalResult result;
        for (int step = 0; step < 40 / time_step; ++step) {
            result = batch.advance(1).front();
            highest = std::max(highest, result.elastic_energy);
        }
        EXPECT_EQ(result.elastic_energy, 0);
        EXPECT_NEAR(result.kinetic_energy / before, 1, 0.1 * time_step * time_step) << time_step;
        EXPECT_NEAR(highest / before, 0.5, 0.01) << "the centre of mass goes on with the other half";
    }
}

}  // namespace
}  // namespace mcdem::reference
