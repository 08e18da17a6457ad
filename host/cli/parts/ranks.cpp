#include "cli/parts/ranks.h"

#include <chrono>
#include <cstdlib>
#include <thread>

#include "core/errors.h"

#ifdef MCDEM_WITH_MPI
#define OMPI_SKIP_MPICXX 1  // only C is used
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>
#endif

namespace mcdem::inline cli {

#ifdef MCDEM_WITH_MPI

struct Ranks::Mpi {
    int rank = 0, size = 1, on_machine = 0;
    MPI_Win window{};
    long* counter = nullptr;  ///< on rank 0; never reset
    long first = 0;           ///< value of the counter at the start of a list
    long listed = 0;
};

namespace {

/// A waiting rank yields its processor to ranks that compute.
void wait_for(MPI_Request request) {
    for (int done = 0; MPI_Test(&request, &done, MPI_STATUS_IGNORE), !done;)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

void send_to_all(void* data, int count, MPI_Datatype type) {
    MPI_Request request;
    MPI_Ibcast(data, count, type, 0, MPI_COMM_WORLD, &request);
    wait_for(request);
}

}  // namespace

Ranks::Ranks() : mpi_(std::make_unique<Mpi>()) {
    MPI_Init(nullptr, nullptr);
    MPI_Comm_rank(MPI_COMM_WORLD, &mpi_->rank);
    MPI_Comm_size(MPI_COMM_WORLD, &mpi_->size);
    MPI_Comm machine;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, mpi_->rank, MPI_INFO_NULL, &machine);
    MPI_Comm_rank(machine, &mpi_->on_machine);
    MPI_Comm_free(&machine);
    const MPI_Aint bytes = mpi_->rank == 0 ? sizeof(long) : 0;
    MPI_Win_allocate(bytes, sizeof(long), MPI_INFO_NULL, MPI_COMM_WORLD, static_cast<void*>(&mpi_->counter),
                     &mpi_->window);
    if (mpi_->rank == 0) *mpi_->counter = 0;
    MPI_Barrier(MPI_COMM_WORLD);
}

Ranks::~Ranks() {
    wait();
    MPI_Win_free(&mpi_->window);
    MPI_Finalize();
}

std::vector<std::size_t> Ranks::agreed(std::vector<std::size_t> list) {
    unsigned long size = list.size();
    send_to_all(&size, 1, MPI_UNSIGNED_LONG);
    list.resize(size);
    static_assert(sizeof(std::size_t) == sizeof(unsigned long));
    send_to_all(list.data(), static_cast<int>(size), MPI_UNSIGNED_LONG);
    mpi_->first += mpi_->listed;
    mpi_->listed = static_cast<long>(size) + mpi_->size;  // each rank passes the end once
    return list;
}

std::size_t Ranks::next() {
    const long one = 1;
    long before = 0;
    MPI_Win_lock(MPI_LOCK_SHARED, 0, 0, mpi_->window);
    MPI_Fetch_and_op(&one, &before, MPI_LONG, 0, 0, MPI_SUM, mpi_->window);
    MPI_Win_unlock(0, mpi_->window);
    return static_cast<std::size_t>(before - mpi_->first);
}

void Ranks::answer() {
    int found = 0;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &found, MPI_STATUS_IGNORE);
}

void Ranks::wait() {
    MPI_Request request;
    MPI_Ibarrier(MPI_COMM_WORLD, &request);
    wait_for(request);
}

void Ranks::abort(int exit_code) {
    MPI_Abort(MPI_COMM_WORLD, exit_code);
    std::_Exit(exit_code);
}

#else

struct Ranks::Mpi {
    int rank = 0, size = 1, on_machine = 0;
};

Ranks::Ranks() {
    throw InputError(
        "--mpi: this program was built without MPI: install libopenmpi-dev and build again, or use --device "
        "all or "
        "--slurm");
}
Ranks::~Ranks() = default;
std::vector<std::size_t> Ranks::agreed(std::vector<std::size_t> list) { return list; }
std::size_t Ranks::next() { return 0; }
void Ranks::answer() {}
void Ranks::wait() {}
void Ranks::abort(int exit_code) { std::_Exit(exit_code); }

#endif

int Ranks::rank() const { return mpi_->rank; }
int Ranks::size() const { return mpi_->size; }
int Ranks::on_machine() const { return mpi_->on_machine; }

}  // namespace mcdem::cli
