#pragma once

#include <string>
#include <vector>

namespace misfit {

/// Columns by the user's choice, named as in the file, with or without the unit. Where inputs are given there are no others; of outputs
/// too.
struct ChosenColumns {
  std::vector<std::string> inputs, outputs;
};

}  // namespace misfit
