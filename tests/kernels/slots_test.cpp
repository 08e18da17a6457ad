// Whole steps with every allowed number of slots, in the device's layout, against the double-precision
// reference.
#include "kernels/steps_as_reference.h"

namespace reference {
namespace {

class Slots : public testing::TestWithParam<int> {};

TEST_P(Slots, FollowTheReference) {
    for (Precision precision : precisions()) {
        std::vector<Start> starts;
        for (ContactModel model : {ContactModel::mc_dem, ContactModel::elastic_sphere})
            for (int count : {1, 17, 64}) {
                starts.push_back(start_of(model, FrictionLaw::mindlin, count, 31));
                // A large probed gap gives grains 18 or more neighbours.
                if (GetParam() > 16) starts.back().replica.numerics.probe_gap = 0.85;
            }
        expect_steps_as_reference(build(precision, GetParam()), starts, 17);
    }
}

INSTANTIATE_TEST_SUITE_P(, Slots, testing::Values(16, 32, 48, 64));

}  // namespace
}  // namespace reference
