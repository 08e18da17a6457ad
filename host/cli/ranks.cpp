#include "cli/ranks.h"

#include "core/errors.h"

#ifdef MCDEM_WITH_MPI
#define OMPI_SKIP_MPICXX 1  // only C is used
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>
#endif

namespace mcdem {

#ifdef MCDEM_WITH_MPI

Rank meet_ranks() {
    Rank me;
    MPI_Init(nullptr, nullptr);
    MPI_Comm_rank(MPI_COMM_WORLD, &me.rank);
    MPI_Comm_size(MPI_COMM_WORLD, &me.size);
    MPI_Comm machine;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, me.rank, MPI_INFO_NULL, &machine);
    MPI_Comm_rank(machine, &me.on_machine);
    MPI_Comm_free(&machine);
    MPI_Finalize();
    return me;
}

#else

Rank meet_ranks() {
    throw InputError(
        "--mpi: this program was built without MPI: install libopenmpi-dev and build again, or use --device "
        "all or "
        "--slurm");
}

#endif

}  // namespace mcdem
