// What would help most next, worked out from the signatures before anything is measured.
#pragma once
#include "diagnose/decide/decision.h"
#include "diagnose/infer/gap_tests.h"

namespace mcdem::inline diagnose {

/// Measurements that would help, the most useful first: with the probability that they tell the leader from
/// its nearest rival where several explain the gap, else with what they make of amplitudes or detection
/// limits.
std::vector<NextStep> next_measurements(const Evidence& evidence, const GapData& data,
                                        const Findings& findings, const Decision& decision,
                                        const Limits& limits);

}  // namespace mcdem::diagnose
