#include "misfit/core/display.h"

#include <fmt/format.h>

#include <cmath>

#include "misfit/core/text.h"
#include "misfit/core/units.h"

namespace misfit {

double display_value(double value, const std::string& si) {
  const std::string unit = display_unit(si);
  return unit == si ? value : convert(value, si, unit);
}

std::vector<double> display_values(std::vector<double> values, const std::string& si) {
  const double factor = display_value(1.0, si);
  for (double& value : values) value *= factor;
  return values;
}

double display_level(double value, const std::string& si) {
  const std::string unit = display_level_unit(si);
  return unit == si ? value : convert(value, si, unit);
}

std::vector<double> display_levels(std::vector<double> values, const std::string& si) {
  const std::string unit = display_level_unit(si);
  if (unit == display_unit(si)) return display_values(std::move(values), si);
  convert(values, si, unit);
  return values;
}

std::string display_field(double value, const std::string& si) {
  return std::isfinite(value) ? fmt::format("{}", display_value(value, si)) : std::string();
}

namespace {

std::string with_unit(const std::string& number, const std::string& unit) {
  return unit == "-" || unit.empty() ? number : number + " " + unit;
}

}  // namespace

std::string with_display_unit(const std::string& number, const std::string& si) { return with_unit(number, display_unit(si)); }

std::string with_level_unit(const std::string& number, const std::string& si) { return with_unit(number, display_level_unit(si)); }

std::string in_display_unit(double value, const std::string& si, double sigma) {
  const double factor = display_value(1.0, si);
  return with_display_unit(format_value(value * factor, sigma * factor), si);
}

std::string in_level_unit(double value, const std::string& si) { return with_level_unit(format_value(display_level(value, si)), si); }

std::string interval_in_display_unit(double low, double high, const std::string& si, double sigma) {
  const double factor = display_value(1.0, si);
  return with_display_unit(format_interval(low * factor, high * factor, sigma * factor), si);
}

}  // namespace misfit
