#pragma once

#include <cstdlib>

#include "tests/apps/program.h"
#include "tests/paths.h"

namespace program {

/// mpirun -n RANKS misfit …, its words to the folder's stdout and stderr, without the colours of
/// a terminal, which it gives its ranks. OpenMPI does not free all that it takes: under sanitizers that is
/// not counted as a leak of ours. Its session has a temporary folder of its own: two that begin and end at once remove the one that they
/// share under each other (orte_session_dir failed).
inline Outcome on_ranks(int ranks, const std::vector<std::string>& arguments) {
  const TemporaryFolder captured;
  std::string command =
      "TMPDIR='" + captured.path().string() +
      "' NO_COLOR=1 ASAN_OPTIONS=detect_leaks=0 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --oversubscribe -n " +
      std::to_string(ranks) + " " + paths::program().string();
  for (const auto& argument : arguments) command += " '" + argument + "'";
  command += " > '" + (captured.path() / "stdout").string() + "' 2> '" + (captured.path() / "stderr").string() + "'";
  const int status = std::system(command.c_str());  // NOLINT(cert-env33-c): a test
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(captured.path() / "stdout"), content(captured.path() / "stderr")};
}

inline bool has_mpi() {
  return fs::exists(paths::program().parent_path() / "misfit_mpi.so") &&
         std::system("mpirun --version > /dev/null 2>&1") == 0;  // NOLINT(cert-env33-c): a test
}

/// MPI is optional: a misfit built without it has nothing to be tested here.
template <class Fixture>
class UnderMpi : public Fixture {
 protected:
  void SetUp() override {
    if (!has_mpi()) GTEST_SKIP() << "misfit was built without MPI, or there is no mpirun";
  }
};

}  // namespace program
