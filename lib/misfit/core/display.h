#pragma once

#include <string>
#include <vector>

namespace misfit {

/// A number of SI unit `si` in display_unit(si). What is no unit to core/units.h (dB) stays as it is.
[[nodiscard]] double display_value(double value, const std::string& si);

[[nodiscard]] std::vector<double> display_values(std::vector<double> values, const std::string& si);

/// The same for values on their scale, in display_level_unit(si): a temperature in degC, where its differences are in K.
[[nodiscard]] double display_level(double value, const std::string& si);
[[nodiscard]] std::vector<double> display_levels(std::vector<double> values, const std::string& si);

/// The same as a field of a CSV: the shortest text that reads back exactly; empty where it is not finite.
[[nodiscard]] std::string display_field(double value, const std::string& si);

/// "12.3 deg" of "12.3" and "rad": a number in display_unit(si) with that unit behind; a pure number ("-" or "") has none.
[[nodiscard]] std::string with_display_unit(const std::string& number, const std::string& si);

/// The same of a value on its scale.
[[nodiscard]] std::string with_level_unit(const std::string& number, const std::string& si);

/// A number for a sentence, in the unit people like to read: "12.30 ± 0.21 deg" for 0.2147 ± 0.0037 rad; a pure number ("-" or "") without
/// one. sigma 0: not estimated, the number alone. InputError: `si` is no unit.
[[nodiscard]] std::string in_display_unit(double value, const std::string& si, double sigma = 0.0);

/// The same of a value on its scale: "20.15 degC".
[[nodiscard]] std::string in_level_unit(double value, const std::string& si);

/// Its 95 % interval: "26.10 to 29.57 N m", to the digits of sigma.
[[nodiscard]] std::string interval_in_display_unit(double low, double high, const std::string& si, double sigma);

}  // namespace misfit
