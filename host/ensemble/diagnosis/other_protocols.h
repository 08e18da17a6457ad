// Would another protocol of the plate tell two explanations of a gap apart? Predicted by runs of both.
#pragma once
#include "ensemble/diagnosis/observe_trials.h"

namespace mcdem::inline ensemble {

struct OtherProtocol {
    std::string what;  ///< "hold the plate at full stroke for 0.3 s"
    TrialSettings common;
    void (*change)(Replica&);  ///< to its protocol
};

/// A hold at full stroke and one more cycle, and for effects that depend on the rate a slower plate; none if
/// the replica has a programme.
std::vector<OtherProtocol> other_protocols(const TrialSettings& common, const Replica& replica, bool slower);

}  // namespace mcdem::ensemble
