// Simulated experiments: the data that an experimenter would have from a simulation.
#pragma once
#include "experiment/instrument.h"

namespace mcdem::inline experiment {

/// `truth` measured with `instrument` (instrument.h). Materials are taken from its parameters. Without
/// positions in frame 0 only the plate is written, because grains and contacts have no identity.
Experiment experiment_from(const Recording& truth, const Instrument& instrument, std::uint64_t seed);

}  // namespace mcdem::experiment
