#include "misfit/jobs/ranks.h"

#include <algorithm>
#include <cstdlib>
#include <thread>
#include <tuple>

#include "misfit/core/module.h"

namespace misfit {
namespace {

class Alone : public Ranks {
 public:
  [[nodiscard]] int rank() const override { return 0; }
  [[nodiscard]] int size() const override { return 1; }
  [[nodiscard]] bool agree(bool ok) override { return ok; }
  void end(int /*status*/) override {}
};

/// OpenMPI's plugins look for its own symbols, hence global.
Ranks& load() {
  const void* entry = load_module({"misfit_mpi.so", "misfit_mpi_module", mpi_module::interface_version, true,
                                   "started by mpirun, but this misfit was built without MPI (it needs OpenMPI's development package "
                                   "when it is built)"});
  return *static_cast<const mpi_module::Entry*>(entry)->start();
}

/// At least 1.
int number_from(const char* variable) {
  const char* text = std::getenv(variable);
  return text == nullptr ? 1 : std::max(1, std::atoi(text));
}

Ranks& started() {
  static Alone alone;
  return ranks_started() > 1 ? load() : alone;
}

}  // namespace

int ranks_started() { return number_from("OMPI_COMM_WORLD_SIZE"); }

int threads_of_rank() {
  if (ranks_started() == 1) return 0;
  const int cores = static_cast<int>(std::thread::hardware_concurrency());  // those that mpirun leaves to this rank
  return std::max(1, cores / number_from("OMPI_COMM_WORLD_LOCAL_SIZE"));
}

Ranks& ranks() {
  static Ranks& all = started();
  return all;
}

void on_first_rank(const std::function<void()>& action) {
  if (!ranks().first()) {
    if (!ranks().agree(true)) throw EndedElsewhere();
    return;
  }
  try {
    action();
  } catch (...) {
    std::ignore = ranks().agree(false);
    throw;
  }
  if (!ranks().agree(true)) throw EndedElsewhere();
}

void end_ranks(int status) {
  if (ranks_started() > 1) ranks().end(status);
}

}  // namespace misfit
