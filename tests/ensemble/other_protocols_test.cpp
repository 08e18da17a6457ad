// Other protocols of the plate, by which a diagnosis could tell effects apart.
#include "ensemble/diagnosis/other_protocols.h"

#include <gtest/gtest.h>

#include "ensemble/small_trials.h"

namespace mcdem {
namespace {

Trial relaxing(const SmallTrials& small, double viscoelasticity) {
    Trial trial = small.trial();
    trial.model.replica.effects.viscoelasticity = viscoelasticity;
    trial.model.replica.effects.relaxation_time = 0.2;
    trial.model.replica.plate.speed = 0.01;  // 1 s down; a fast plate shakes the packing
    return trial;
}

Eigen::VectorXd observed(const SmallTrials& small, Trial trial, const OtherProtocol* protocol) {
    Device device;
    if (protocol) protocol->change(trial.model.replica);
    return observe_trials(device, protocol ? protocol->common : small.common, {trial}, small.store, {})
        .row(0)
        .transpose();
}

// The top force relaxes by at most the relaxing fraction, and only for viscoelastic grains.
TEST(OtherProtocols, AHoldAtFullStrokeShowsRelaxation) {
    const SmallTrials small;
    const Trial soft = relaxing(small, 0.4), elastic = relaxing(small, 0);
    const auto protocols = other_protocols(small.common, soft.model.replica, false);
    ASSERT_EQ(protocols.size(), 2u);
    EXPECT_EQ(protocols[0].what, "hold the plate at full stroke for 0.6 s");
    const auto bins = bins_of(small.common.grid);
    const Eigen::VectorXd stroke = observed(small, soft, nullptr),
                          held = observed(small, soft, &protocols[0]),
                          rigid = observed(small, elastic, &protocols[0]);
    int found = 0;
    for (std::size_t c = 0; c < bins.size(); ++c) {
        const auto bin = static_cast<Eigen::Index>(c);
        if (bins[c].observable != index_of(OfProgramme::relaxation)) {
            EXPECT_EQ(std::isfinite(stroke[bin]), std::isfinite(held[bin])) << c;
            continue;
        }
        EXPECT_TRUE(std::isnan(stroke[bin]));
        if (std::isnan(held[bin])) continue;
        ++found;
        EXPECT_EQ(bins[c].displacement, small.common.grid.displacement.back());
        EXPECT_GT(held[bin], rigid[bin] + 0.1);
    }
    EXPECT_EQ(found, 1);
}

TEST(OtherProtocols, OneMoreCycleHasTheBinsOfOne) {
    const SmallTrials small;
    Trial trial = small.trial();
    trial.model.replica.effects.plasticity = 0.3;
    const auto protocols = other_protocols(small.common, trial.model.replica, false);
    const Eigen::VectorXd one = observed(small, trial, nullptr), two = observed(small, trial, &protocols[1]);
    EXPECT_FALSE(same(one, two));
    for (Eigen::Index bin = 0; bin < one.size(); ++bin)
        EXPECT_TRUE(std::isfinite(two[bin]) || !std::isfinite(one[bin])) << bin;
}

// A slower plate leaves more time to relax: of the elastic force at full stroke less is left.
TEST(OtherProtocols, ASlowerPlateShowsTheRate) {
    const SmallTrials small;
    const Trial soft = relaxing(small, 0.4), elastic = relaxing(small, 0);
    const auto protocols = other_protocols(small.common, soft.model.replica, true);
    ASSERT_EQ(protocols.size(), 3u);
    EXPECT_EQ(protocols[2].what, "press 4 times slower");
    const auto bins = bins_of(small.common.grid);
    const auto force = [&](const Trial& trial, const OtherProtocol* protocol) {
        const Eigen::VectorXd seen = observed(small, trial, protocol);
        for (std::size_t c = 0; c < bins.size(); ++c)
            if (observables()[static_cast<std::size_t>(bins[c].observable)].name == "top_force" &&
                bins[c].displacement == small.common.grid.displacement.back() && bins[c].phase == Phase::load)
                return seen[static_cast<Eigen::Index>(c)];
        return std::nan("");
    };
    const double left = force(soft, nullptr) / force(elastic, nullptr),
                 left_if_slower = force(soft, &protocols[2]) / force(elastic, &protocols[2]);
    EXPECT_LT(left_if_slower, left - 0.02);
    EXPECT_GT(left_if_slower, 0.6 - 0.02);  // all of 0.4 has relaxed
}

TEST(OtherProtocols, AreNotMadeOfAProgramme) {
    const SmallTrials small;
    Replica replica = small.model.replica;
    replica.programme.resize(1);
    EXPECT_TRUE(other_protocols(small.common, replica, true).empty());
}

}  // namespace
}  // namespace mcdem
