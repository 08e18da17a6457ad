// Simulations as realities: what an experimenter would have who measured one.
#pragma once
#include "experiment/instrument.h"

namespace mcdem::inline experiment {

/// `truth` seen through `instrument` (instrument.h). Materials are those of its parameters. Without positions
/// in frame 0 only the plate is left, for grains and contacts could not be named.
Experiment experiment_from(const Recording& truth, const Instrument& instrument, std::uint64_t seed);

}  // namespace mcdem::experiment
