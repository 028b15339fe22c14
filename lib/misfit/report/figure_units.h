#pragma once

#include <string>
#include <vector>

#include "misfit/core/units.h"

namespace misfit::report {

/// Values of unit `si` in the unit that figures show.
[[nodiscard]] inline std::vector<double> shown(std::vector<double> values, const std::string& si) {
  const double factor = convert(1.0, si, display_unit(si));
  for (double& value : values) value *= factor;
  return values;
}

/// A text as part of a file name or a column's key: everything but letters, digits, '-' becomes '_'.
[[nodiscard]] inline std::string as_key(const std::string& text) {
  std::string key;
  for (const char c : text) key += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ? c : '_';
  return key;
}

}  // namespace misfit::report
