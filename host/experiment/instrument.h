// The measurement: how a packing as it is becomes a packing as it is read. Simulations go through the same
// instrument as the experiment before the two are compared.
#pragma once
#include <cstdint>

#include "experiment/experiment.h"

namespace mcdem {

/// What the instrument states of itself, and where it is wrong without knowing.
struct Instrument {
    Measurement stated;
    double force_bias = 0;       ///< contact forces are read (1 + force_bias) times too large
    double threshold_shift = 0;  ///< true force threshold less the stated one [N]
    double position_bias = 0;    ///< lengths between centres are read (1 + position_bias) times too large
    double strain_offset = 0;    ///< plate positions are read too high by this [m]
};

/// `truth` as the instrument reads it: noise on positions (of each scan), diameters and contact forces, contacts
/// below the threshold gone, averages over contacts not known. Top forces are read exactly. The
/// same seed gives the same noise.
Recording measured(const Recording& truth, const Instrument& instrument, std::uint64_t seed);

}  // namespace mcdem
