// The ranks that mpirun or srun has started, and the parts dealt to them by a counter.
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

namespace mcdem::inline cli {

/// MPI, for as long as this lives; once a process. A rank that is lost ends the others, as MPI does.
class Ranks {
public:
    /// Throws InputError where the program was built without MPI.
    Ranks();
    ~Ranks();
    Ranks(const Ranks&) = delete;

    int rank() const;
    int size() const;
    int on_machine() const;  ///< number of this rank among those of its machine

    /// The list of rank 0, on all of them. Then `next` counts from 0 again.
    std::vector<std::size_t> agreed(std::vector<std::size_t> list);
    /// A place in that list that no other rank gets; past its end, once for each rank, where all are dealt.
    std::size_t next();
    /// To be called often by one that computes: lets others count.
    void answer();
    /// Until all ranks are here.
    void wait();
    [[noreturn]] void abort(int exit_code);

private:
    struct Mpi;
    std::unique_ptr<Mpi> mpi_;
};

}  // namespace mcdem::cli
