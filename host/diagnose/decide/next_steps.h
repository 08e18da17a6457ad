// Recommended next measurements, predicted from the signatures.
#pragma once
#include "diagnose/decide/decision.h"
#include "diagnose/infer/gap_tests.h"

namespace mcdem::inline diagnose {

/// Useful measurements, best first. If several effects explain the gap: with the probability that they
/// distinguish the leading effect from its nearest rival; otherwise with the resulting errors of amplitudes
/// or detection limits.
std::vector<NextStep> next_measurements(const Evidence& evidence, const GapData& data,
                                        const Findings& findings, const Decision& decision,
                                        const Limits& limits);

}  // namespace mcdem::diagnose
