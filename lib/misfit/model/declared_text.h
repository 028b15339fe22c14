#pragma once

// Inside of declared systems: not for other files.

#include <optional>
#include <string>
#include <vector>

#include "misfit/core/keys.h"
#include "misfit/data/study.h"
#include "misfit/formula/build.h"
#include "misfit/model/system.h"

namespace misfit::declared {

/// A formula that stands in a file, and what it is for.
struct Formula {
  formula::Syntax syntax;
  formula::Measure measure;  ///< unit it must have
};

/// A declared system as read: names, units and syntax are checked, formulas not yet built.
struct Declaration {
  SystemSpec spec;                  ///< states, inputs, ports, constants, outputs; quantities as declared, in order
  std::vector<Formula> quantities;  ///< of spec.quantities
  std::vector<Formula> equations;   ///< per state
  std::vector<Formula> outputs;
  Source where;  ///< of the file
  std::optional<config::DescribedSection> roles;
};

[[nodiscard]] Declaration read(const std::string& text, const std::string& file, const std::string& key);

/// InputError at `study`: it has no such input.
void set_hold(Declaration& declaration, const std::string& input, const HoldStudy& study);

}  // namespace misfit::declared
