#pragma once

#include <filesystem>
#include <string>

#include "misfit/core/table.h"
#include "misfit/workflow/session/session.h"

namespace misfit {

/// A motion that the model makes.
struct SimulatedRecord {
  Table table;                 ///< t [s], then every output in its display unit; with noise added: its value without noise as NAME_true
  std::string system;          ///< kind
  std::filesystem::path file;  ///< simulation.csv
};

/// simulation.csv: the motion that [simulate] describes or, without that section, the motion of the model as last fitted, over the inputs
/// of the first experiment. InputError: a name or unit of [simulate] that does not suit the system. RunError: nothing is fitted to simulate
/// with, or the simulation diverged.
SimulatedRecord simulate_stage(Session& session);

}  // namespace misfit
