// Compares whole steps of an engine with the double-precision reference.
#pragma once
#include <fmt/core.h>

#include "core/names.h"
#include "reference/test_scene.h"

namespace mcdem::reference {

/// Expects six steps as the reference makes them (compare_steps). `slack` multiplies the tolerance.
inline void expect_steps_as_reference(const KernelBuild& build, const std::vector<Start>& starts,
                                      unsigned seed, double slack = 1) {
    compare_steps(device(), build, starts, seed, slack, 0,
                  [&](int step, std::size_t r, const IntervalResult& result, const Differences& d) {
                      const ContactModel model = starts[r].replica.contact.model;
                      const std::string where =
                          fmt::format("step {}, replica {} ({}, {} grains): {}", step, r, name(model),
                                      starts[r].packing.size(), text(d));
                      EXPECT_EQ(result.status, 0) << where;
                      EXPECT_TRUE(d.same_contacts) << where;
                      EXPECT_LT(d.worst(), slack * tolerance(build.precision, model)) << where;
                  });
}

inline Start start_of(ContactModel model, FrictionLaw law, int count, unsigned seed) {
    Replica replica = test_replica(model);
    replica.contact.friction_law = law;
    return jittered_lattice(replica, count, seed);
}

inline std::vector<Precision> precisions() {
    if (has_double()) return {Precision::single_precision, Precision::double_precision};
    return {Precision::single_precision};
}

}  // namespace mcdem::reference
