// The ranks that mpirun or srun has started.
#pragma once
#include <string>

namespace mcdem {

struct Rank {
    int rank = 0, size = 1;  ///< of all
    int on_machine = 0;      ///< number of this rank among those of its machine
};

/// Who this rank is; MPI is not used any more after it, so that no rank waits for one that was lost. To be
/// called once. Throws InputError where the program was built without MPI.
Rank meet_ranks();

}  // namespace mcdem
