#pragma once

#include <filesystem>
#include <string>

namespace misfit {

/// What a program needs only sometimes, and loads only then.
struct ModuleRequest {
  std::string file;       ///< "misfit_mpi.so"
  std::string symbol;     ///< of the exported Entry
  int version = 0;        ///< that the Entry has to have
  bool global = false;    ///< its symbols are for libraries that it loads itself
  std::string complaint;  ///< begins the RunError
};

/// The `symbol` of a module, looked for where the program's run path and LD_LIBRARY_PATH say, beside the program, one folder above it, and
/// in ../lib*/misfit. It must begin with an int, its version. Never closed: what stands behind keeps threads and static objects. RunError
/// naming what was tried if none is there or of this version.
[[nodiscard]] const void* load_module(const ModuleRequest& request);

/// A program that misfit starts to do one thing, looked for in the same places. RunError, begun by `complaint`, if it is in none.
[[nodiscard]] std::filesystem::path helper_program(const std::string& file, const std::string& complaint);

}  // namespace misfit
