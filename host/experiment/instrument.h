// The measurement: how a packing as it is becomes a packing as it is read. Simulations go through the same
// instrument as the experiment before the two are compared.
#pragma once
#include <cstdint>

#include "experiment/experiment.h"

namespace mcdem::inline experiment {

/// What the instrument states of itself, and where it is wrong without knowing.
struct Instrument {
    Measurement stated;
    double force_bias = 0;        ///< contact forces are read (1 + force_bias) times too large
    double threshold_shift = 0;   ///< true force threshold less the stated one [N]
    double position_bias = 0;     ///< lengths between centres are read (1 + position_bias) times too large
    double strain_offset = 0;     ///< plate positions are read too high by this [m]
    double gauge_drift = 0;       ///< after the last cycle the top force is read (1 + gauge_drift) times too
                                  ///< large; it grows with the plate's path
    double zero_drift = 0;        ///< .. and larger by zero_drift of the highest, whatever it is; grows alike
    double gauge_hysteresis = 0;  ///< on the way up the top force F is read larger by 4 gauge_hysteresis
                                  ///< F (1 - F/F_max), F_max the highest: by gauge_hysteresis F_max at most
    double force_lag = 0;       ///< the top force is that of an earlier plate position, this far back [m]; it
                                ///< catches up where the plate rests
    double guide_friction = 0;  ///< as soon as the plate moves, the top force is read larger on the way down
                                ///< and smaller on the way up, by guide_friction F_max
    double force_saturation = 0;  ///< a contact force f is read as f/(1 + force_saturation f) [1/N]
};

/// `truth` as the instrument reads it, in the form of an experiment that was read: normal noise on
/// positions (anew in each scan), on diameters and on the size of contact forces; contact points err with the
/// centres beside them; contacts below the threshold are gone. Lengths are read too large from the middle of
/// the floor. Of the walls' forces the top force is read without noise, the others are the sums of the
/// contacts seen; what an experiment does not know (energies, overlaps, packing fraction) is not-a-number.
/// The noise depends on the seed and on what is measured (scan, grain, partner) only: of two similar packings
/// it is alike.
Recording measured(const Recording& truth, const Instrument& instrument, std::uint64_t seed);

}  // namespace mcdem::experiment
