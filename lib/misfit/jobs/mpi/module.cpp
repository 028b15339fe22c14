// misfit_mpi.so: the only thing that is linked to MPI, loaded when mpirun has started the program (jobs/ranks.h).
#include <mpi.h>

#include <chrono>
#include <thread>

#include "misfit/jobs/ranks.h"

namespace {

class Mpi : public misfit::Ranks {
 public:
  Mpi() {
    MPI_Init(nullptr, nullptr);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }
  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int size() const override { return size_; }
  [[nodiscard]] bool agree(bool ok) override {
    int mine = ok ? 1 : 0, all = 0, done = 0;
    MPI_Request request{};
    MPI_Iallreduce(&mine, &all, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD, &request);
    // MPI itself would wait at full speed and take the core from a rank that still works.
    for (MPI_Test(&request, &done, MPI_STATUS_IGNORE); done == 0; MPI_Test(&request, &done, MPI_STATUS_IGNORE))
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    agreed_on_failure_ = all == 0;
    return all == 1;
  }
  void end(int status) override {
    if (status != 0 && !agreed_on_failure_) MPI_Abort(MPI_COMM_WORLD, status);
    MPI_Finalize();
  }

 private:
  int rank_ = 0, size_ = 1;
  bool agreed_on_failure_ = false;
};

misfit::Ranks* start() {
  static Mpi mpi;
  return &mpi;
}

}  // namespace

extern "C" __attribute__((visibility("default")))
const misfit::mpi_module::Entry misfit_mpi_module{misfit::mpi_module::interface_version, &start};
