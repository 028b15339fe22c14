#include "misfit/core/ranks.h"

#include <algorithm>
#include <cstdlib>

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

Ranks& started() {
  static Alone alone;
  return ranks_started() > 1 ? load() : alone;
}

}  // namespace

int ranks_started() {
  const char* size = std::getenv("OMPI_COMM_WORLD_SIZE");
  return size == nullptr ? 1 : std::max(1, std::atoi(size));
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
    static_cast<void>(ranks().agree(false));
    throw;
  }
  if (!ranks().agree(true)) throw EndedElsewhere();
}

void end_ranks(int status) {
  if (ranks_started() > 1) ranks().end(status);
}

}  // namespace misfit
