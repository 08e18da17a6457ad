// MPI ranks started by mpirun or srun, and a counter that deals parts to them.
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

namespace mcdem::inline cli {

/// Initialises MPI for the lifetime of the object; use it once per process. If a rank is lost, MPI ends the
/// others.
class Ranks {
public:
    /// Throws InputError if the program was built without MPI.
    Ranks();
    ~Ranks();
    Ranks(const Ranks&) = delete;

    int rank() const;
    int size() const;
    int on_machine() const;  ///< number of this rank among those on its machine

    /// Returns the list of rank 0 on all ranks. `next` then counts from 0 again.
    std::vector<std::size_t> agreed(std::vector<std::size_t> list);
    /// Index in that list that no other rank gets; past its end when all are dealt.
    std::size_t next();
    /// Must be called often by a rank that computes, so that others can use the counter.
    void answer();
    /// Waits for all ranks.
    void wait();
    [[noreturn]] void abort(int exit_code);

private:
    struct Mpi;
    std::unique_ptr<Mpi> mpi_;
};

}  // namespace mcdem::cli
