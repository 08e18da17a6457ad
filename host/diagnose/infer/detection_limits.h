// What these data could show at all, worked out before they are looked at.
#pragma once
#include "diagnose/decide/decision.h"
#include "diagnose/infer/gap_tests.h"

namespace mcdem::inline diagnose {

/// One limit a candidate effect: the amplitude that the directed test detects four times out of five, what
/// refitting the nuisances takes away of its signature, and the effects not to be told from it at twice that
/// amplitude.
std::vector<DetectionLimit> detection_limits(const GapSpace& space, const GapData& data,
                                             const NullDistribution& null, const Evidence& evidence,
                                             const Limits& limits);

}  // namespace mcdem::diagnose
