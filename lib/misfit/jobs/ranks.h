#pragma once

#include <exception>
#include <functional>

namespace misfit {

/// The processes of one `mpirun -n k misfit …`: each runs the same command; they share its jobs and its run folder, which must lie on a
/// disk that all of them see. Without mpirun: one process, rank 0 of 1.
class Ranks {
 public:
  Ranks() = default;
  virtual ~Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  [[nodiscard]] virtual int rank() const = 0;
  [[nodiscard]] virtual int size() const = 0;
  [[nodiscard]] bool first() const { return rank() == 0; }
  /// Waits for all ranks; true if `ok` on every one of them. All must call it equally often.
  [[nodiscard]] virtual bool agree(bool ok) = 0;
  /// The last thing a process does: waits for the others if they know how this ends (status 0, or agree() said false), else ends them all.
  virtual void end(int status) = 0;
};

/// Of this process. MPI is loaded (misfit_mpi.so, beside the program or where its run path says) and started only when mpirun of OpenMPI
/// said so in the environment (OMPI_COMM_WORLD_SIZE above 1); else nothing is. RunError if misfit was built without MPI.
[[nodiscard]] Ranks& ranks();

/// ranks().end(status) under mpirun, else nothing.
void end_ranks(int status);

/// How many ranks mpirun has started, without starting MPI: 1 without mpirun.
[[nodiscard]] int ranks_started();

/// Threads of this rank where nobody said how many: its share of the machine's cores. 0, one per core, without mpirun.
[[nodiscard]] int threads_of_rank();

/// Thrown on the ranks that were waiting for one that failed: that one says why.
class EndedElsewhere : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "another rank failed"; }
};

/// What only one process may do, as writing into a run folder: the first rank does it while the others wait. They throw EndedElsewhere if
/// it throws there.
void on_first_rank(const std::function<void()>& action);

namespace mpi_module {

/// What misfit_mpi.so exports under the name misfit_mpi_module.
struct Entry {
  int version;
  Ranks* (*start)();  ///< MPI_Init; lives until the process ends
};
inline constexpr int interface_version = 1;

}  // namespace mpi_module
}  // namespace misfit
