#include "misfit/report/reference_series.h"

#include "misfit/report/figure_units.h"
#include "misfit/report/style.h"

namespace misfit::report {

Series reference_series(const Reference& reference, const std::string& legend) {
  const std::vector<double> x = shown(reference.x, reference.of_unit), y = shown(reference.value, reference.unit);
  Series s{as_key(reference.name), legend, Style::error_bars, black, x, y, {}, {}};
  const std::vector<double> sigma = shown(reference.sigma, reference.unit);
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    s.lo.push_back(s.y[i] - sigma[i]);
    s.hi.push_back(s.y[i] + sigma[i]);
  }
  return s;
}

}  // namespace misfit::report
