// Runs a scene and collects what it yields.
#pragma once
#include <optional>

#include "reference/test_scene.h"
#include "sim/simulation.h"

namespace mcdem::reference {

struct Simulated {
    std::vector<std::vector<mcdem::Scan>> scans;  ///< of each replica
    std::vector<std::optional<mcdem::Failure>> failures;
    double progress = 0;  ///< at the end
    bool under_way(std::size_t r, std::size_t wanted) const {
        return !failures[r] && scans[r].size() < wanted;
    }
};

/// Until every replica has `wanted` scans, has failed or has finished. Failures are failures of the test,
/// unless it `fails` as it should.
inline Simulated simulated(const mcdem::Scene& scene, const std::vector<Packing>& packings,
                           bool fails = false, std::size_t wanted = 1'000'000) {
    mcdem::Simulation simulation(device(), scene, packings);
    Simulated all{std::vector<std::vector<mcdem::Scan>>(packings.size()),
                  std::vector<std::optional<mcdem::Failure>>(packings.size())};
    const auto take = [&](int r, mcdem::Scan scan) { all.scans[r].push_back(std::move(scan)); };
    const auto fail = [&](int r, const mcdem::Failure& failure) {
        EXPECT_FALSE(all.failures[r]) << "twice";
        all.failures[r] = failure;
        if (!fails) ADD_FAILURE() << "replica " << r << ": " << failure.cause;
    };
    const auto any = [&] {
        for (std::size_t r = 0; r < packings.size(); ++r)
            if (all.under_way(r, wanted)) return true;
        return false;
    };
    while (any() && simulation.advance(take, fail)) {
    }
    all.progress = simulation.progress();
    return all;
}

inline Simulated simulated(const mcdem::Scene& scene, const Packing& packing, bool fails = false) {
    return simulated(scene, std::vector<Packing>{packing}, fails);
}

}  // namespace mcdem::reference
