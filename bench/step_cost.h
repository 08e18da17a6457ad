// What one grain-step asks of the machine, counted from kernels/advance.cl and the headers it includes.
#pragma once
#include "core/names.h"

namespace mcdem::bench {

struct StepCost {
    double bytes = 0;  ///< of memory traffic, read and written, if every field crosses once [bytes]
    double flops = 0;  ///< as executed: empty slots count as well
};

/// `contacts`: Z, contacts a grain. For Poisson ratio 1/2, where two terms of Eq. 1 vanish. The neighbour
/// list (made anew every few dozen steps) and measuring (once an interval) are left out.
StepCost step_cost(ContactModel model, FrictionLaw friction, Precision precision, double contacts);

}  // namespace mcdem::bench
