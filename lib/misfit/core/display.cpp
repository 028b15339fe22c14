#include "misfit/core/display.h"

#include <fmt/format.h>

#include <cmath>

#include "misfit/core/text.h"
#include "misfit/core/units.h"

namespace misfit {
namespace {

struct Display {
  double factor;
  std::string unit;  ///< with a space before it; empty for a pure number

  explicit Display(const std::string& si) {
    const std::string shown = display_unit(si);
    factor = shown == si ? 1.0 : convert(1.0, si, shown);
    unit = shown == "-" || shown.empty() ? "" : " " + shown;
  }
};

}  // namespace

double display_value(double value, const std::string& si) {
  const std::string unit = display_unit(si);
  return unit == si ? value : convert(value, si, unit);
}

std::vector<double> display_values(std::vector<double> values, const std::string& si) {
  const double factor = Display(si).factor;
  for (double& value : values) value *= factor;
  return values;
}

std::string display_field(double value, const std::string& si) {
  return std::isfinite(value) ? fmt::format("{}", display_value(value, si)) : std::string();
}

std::string in_display_unit(double value, const std::string& si, double sigma) {
  const Display display(si);
  return format_value(value * display.factor, sigma * display.factor) + display.unit;
}

std::string interval_in_display_unit(double low, double high, const std::string& si, double sigma) {
  const Display display(si);
  return format_interval(low * display.factor, high * display.factor, sigma * display.factor) + display.unit;
}

}  // namespace misfit
