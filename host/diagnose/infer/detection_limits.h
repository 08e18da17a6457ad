// Detection limits of the given kind of data, computed before the data are used.
#pragma once
#include "diagnose/decide/decision.h"
#include "diagnose/infer/gap_tests.h"

namespace mcdem::inline diagnose {

/// One limit per candidate effect: the amplitude that the directed test detects in four of five cases, the
/// part of its signature that refitted nuisances absorb, and the effects that cannot be distinguished from it
/// at twice that amplitude.
std::vector<DetectionLimit> detection_limits(const GapSpace& space, const GapData& data,
                                             const NullDistribution& null, const Evidence& evidence,
                                             const Limits& limits);

}  // namespace mcdem::diagnose
