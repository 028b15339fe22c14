#pragma once

#include <vector>

namespace misfit {

/// How well a measured column is predicted, over a sixteenth of its swing ahead, by its own past and with the past of others besides.
struct Influence {
  double own = 0.0;     ///< share of the change's variance that its own past predicts
  double others = 0.0;  ///< share that the others' past adds
  /// The others matter: they add 2 % of the variance or more, and take away 12 % or more of what its own past leaves open.
  [[nodiscard]] bool matters() const { return others > 0.02 && others > 0.12 * (1.0 - own); }
};

/// Granger's comparison: C. W. J. Granger, Econometrica 37 (1969) 424–438. Linear regressions of y(k + H) − y(k) on the values and the
/// means over H/2 samples now, H and 2 H earlier, of drivers also over the two halves of what lies ahead, fitted and compared on separate
/// stretches; NaN: missing. `drivers`: known to be inputs. Constant columns do not count. All 0 where there are too few rows.
[[nodiscard]] Influence influence_on(const std::vector<double>& y, const std::vector<std::vector<double>>& others,
                                     const std::vector<std::vector<double>>& drivers = {});

}  // namespace misfit
