#include "misfit/core/display.h"

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

std::string in_display_unit(double value, const std::string& si, double sigma) {
  const Display display(si);
  return format_value(value * display.factor, sigma * display.factor) + display.unit;
}

std::string interval_in_display_unit(double low, double high, const std::string& si, double sigma) {
  const Display display(si);
  return format_interval(low * display.factor, high * display.factor, sigma * display.factor) + display.unit;
}

}  // namespace misfit
