#include "misfit/core/ranks.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "misfit/core/error.h"

namespace misfit {
namespace {

namespace fs = std::filesystem;

class Alone : public Ranks {
 public:
  [[nodiscard]] int rank() const override { return 0; }
  [[nodiscard]] int size() const override { return 1; }
  [[nodiscard]] bool agree(bool ok) override { return ok; }
  void end(int /*status*/) override {}
};

std::vector<std::string> places() {
  constexpr const char* file_name = "misfit_mpi.so";
  std::vector<std::string> out{file_name};
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  if (error) return out;
  for (const char* folder : {".", "..", "../lib/misfit", "../lib/x86_64-linux-gnu/misfit", "../lib64/misfit"})
    out.push_back((program / folder / file_name).lexically_normal().string());
  return out;
}

/// Never closed: OpenMPI keeps threads and static objects. Its plugins look for its own symbols, hence global.
Ranks& load() {
  std::string tried;
  for (const std::string& place : places()) {
    if (place.find('/') != std::string::npos && !fs::exists(place)) continue;
    void* handle = ::dlopen(place.c_str(), RTLD_NOW | RTLD_GLOBAL);
    if (handle == nullptr) {
      tried += std::string("\n  ") + ::dlerror();
      continue;
    }
    const auto* entry = static_cast<const mpi_module::Entry*>(::dlsym(handle, "misfit_mpi_module"));
    if (entry != nullptr && entry->version == mpi_module::interface_version) return *entry->start();
    tried += "\n  " + place + ": of another version of misfit";
  }
  throw RunError("started by mpirun, but this misfit was built without MPI (it needs OpenMPI's development package when it is built):" +
                 tried);
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
