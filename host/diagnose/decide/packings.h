// Agreement between several packings of an experiment: distinguishes scatter between packings from an effect.
#pragma once
#include "diagnose/infer/proposals.h"

namespace mcdem::inline diagnose {

/// One entry per packing of the evidence; none for a single packing. `decided`: the proposal of the verdict,
/// or null; the amplitude of its first effect is estimated for each packing.
std::vector<PackingAgreement> packing_agreements(const Evidence& evidence, const GapData& data,
                                                 const NullDistribution& null, const Proposal* decided,
                                                 const Limits& limits);

}  // namespace mcdem::diagnose
