// Cost of one grain-step, counted from kernels/advance.cl and the headers that it includes.
#pragma once
#include "core/names.h"

namespace mcdem::bench {

struct StepCost {
    double bytes = 0;  ///< memory traffic, read and written, if every field is transferred once [bytes]
    double flops = 0;  ///< as executed on a CPU, including empty slots
};

/// For dense packings with 16 slots and about six contacts per grain. For Poisson ratio 1/2, where two terms
/// of Eq. 1 vanish. Without neighbour-list rebuilds (every few dozen steps) and measuring (once per
/// interval).
StepCost step_cost(ContactModel model, FrictionLaw friction, Precision precision);

}  // namespace mcdem::bench
