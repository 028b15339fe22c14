#pragma once

#include <string>

namespace misfit {

/// "omega1_radps" → {"omega1", "rad/s"}; "theta[deg]" → {"theta", "deg"}; "Flow (gal/min)" → {"Flow", ""} as gallons are not known; "T
/// (°C)" → {"T", "degC"}; "ms" → {"ms", "ms"}, "rpm" → {"rpm", "rpm"}: a header may be nothing but a unit that is no usual name.
/// Behind '_' stand subscripts as well: "min" is a unit behind a word for time alone, and one letter behind T none but K ("T_s", "T_m").
struct NameAndUnit {
  std::string name, unit;      ///< unit empty if the header names none that is known
  std::string not_understood;  ///< a unit in brackets that is not known
  bool of_one_letter = false;  ///< the unit is the last letter of the name: it may be a subscript
};
[[nodiscard]] NameAndUnit read_header(const std::string& header);

}  // namespace misfit
