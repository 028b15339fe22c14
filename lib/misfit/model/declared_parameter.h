#pragma once

#include <limits>
#include <optional>
#include <string>

#include "misfit/core/keys.h"
#include "misfit/formula/measure.h"
#include "misfit/model/system.h"

namespace misfit::declared {

/// A parameter as a declaration gives it (declared_parameter_keys of study_keys.h), numbers in SI.
struct ParameterText {
  std::string unit, doc;
  formula::Measure measure;
  std::optional<double> value, sigma, scale;
  bool free = true;
  double lower = -std::numeric_limits<double>::infinity(), upper = std::numeric_limits<double>::infinity();  ///< none unless given
};

/// InputError at its place for a missing or unknown unit, bounds that do not increase, a value outside them, a sigma or scale not above 0.
[[nodiscard]] ParameterText read_parameter(const config::DescribedSection& section);

/// The unit of an entry, which must be there and SI.
[[nodiscard]] std::string read_unit(const config::Section& section);

/// The same as the system has it shown, where its [display] says so: radian for rad, "W (shown in kW)" for W, "K/W (shown in K/kW)" for
/// K/W. A parameter without unit is not shown in per cent.
[[nodiscard]] std::string shown_unit(const std::string& unit, const SystemSpec& system);

/// The same of a state, input, output or quantity, which may be shown in per cent.
[[nodiscard]] std::string shown_unit_of_channel(const std::string& unit, const SystemSpec& system);

}  // namespace misfit::declared
