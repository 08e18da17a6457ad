// Whether several packings of an experiment show the same gap: scatter between packings told from an effect.
#pragma once
#include "diagnose/infer/proposals.h"

namespace mcdem::inline diagnose {

/// Of each packing of the evidence; none where there is only one. `decided`: what the verdict is about, or
/// null; each packing is asked for the amplitude of its first effect.
std::vector<PackingAgreement> packing_agreements(const Evidence& evidence, const GapData& data,
                                                 const NullDistribution& null, const Proposal* decided,
                                                 const Limits& limits);

}  // namespace mcdem::diagnose
