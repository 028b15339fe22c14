#include "misfit/core/display.h"

#include "misfit/core/text.h"
#include "misfit/core/units.h"

namespace misfit {

std::string in_display_unit(double value, const std::string& si, double sigma) {
  const std::string unit = display_unit(si);
  const double factor = unit == si ? 1.0 : convert(1.0, si, unit);
  return format_value(value * factor, sigma * factor) + (unit == "-" || unit.empty() ? "" : " " + unit);
}

}  // namespace misfit
