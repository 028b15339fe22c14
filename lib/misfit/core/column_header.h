#pragma once

#include <span>
#include <string>
#include <string_view>

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

/// The name, in small letters, or the name with a number behind it ("u1") is among the words.
[[nodiscard]] bool is_called(const std::string& name, std::span<const std::string_view> words);
/// A name without its unit that says time: "t", "Time", "zeit".
[[nodiscard]] bool is_called_time(const std::string& name);
/// It says time by its letter alone: "T", "T1", "t_2".
[[nodiscard]] bool may_be_temperature(const std::string& name);

}  // namespace misfit
