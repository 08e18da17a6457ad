// From evidence to verdict: what can be told, whether there is a gap, where, which effect, how far it shrinks.
#pragma once
#include "diagnose/identification.h"
#include "diagnose/shrinkage.h"

namespace mcdem {

/// A diagnosis as far as signatures carry it, and what the confirming runs are to be made with.
struct Draft {
    Diagnosis diagnosis;
    Setting setting;
    Identification identification;
    int mean_of = 0;              ///< baseline replicates behind Setting::mean
    bool worth_confirming = false;  ///< there is a gap and an effect to try
    PartialFit whole;             ///< of the best explanation, fitted on everything
    PartialFit part;              ///< .. fitted on the part that is not held out
};

/// Throws InputError where the observation shares no cells with the library. `evidence` must outlive the draft.
Draft draft_diagnosis(const Evidence& evidence, const Limits& limits);

/// Real runs of the best explanation with the amplitudes and nuisances of the draft; row: replicate.
struct Confirmation {
    Eigen::MatrixXd whole, part;
};
/// Puts what the real runs say into the diagnosis: the confirmed score and shrink, and where the real runs leave a gap
/// that the signatures hid, the verdict.
Diagnosis confirm(const Evidence& evidence, Draft draft, const Confirmation& confirmation, const Limits& limits);

}  // namespace mcdem
