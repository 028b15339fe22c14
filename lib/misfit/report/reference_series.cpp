#include "misfit/report/reference_series.h"

#include "misfit/core/display.h"
#include "misfit/report/figure_units.h"
#include "misfit/report/style.h"

namespace misfit::report {

Series reference_series(const Reference& reference, const std::string& legend) {
  const std::vector<double> x = display_values(reference.x, reference.of_unit), y = display_values(reference.value, reference.unit);
  Series s{as_key(reference.name), legend, Style::error_bars, black, x, y, {}, {}};
  const std::vector<double> sigma = display_values(reference.sigma, reference.unit);
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    s.lo.push_back(s.y[i] - sigma[i]);
    s.hi.push_back(s.y[i] + sigma[i]);
  }
  return s;
}

}  // namespace misfit::report
