#include "misfit/inference/own_clocks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/math/statistics.h"

namespace misfit {

bool MeasuredTogether::have_own_clocks() const {
  constexpr double together = 0.5;
  for (Eigen::Index a = 0; a < pairs_.rows(); ++a) {
    for (Eigen::Index b = 0; b < a; ++b) {
      const double fewer = std::min(pairs_(a, a), pairs_(b, b));
      if (fewer > 0.0 && pairs_(a, b) < together * fewer) return true;
    }
  }
  return false;
}

bool have_own_clocks(const Signals& signals) {
  if (signals.measured.size() < 2) return false;
  MeasuredTogether together(std::ssize(signals.measured));
  Eigen::VectorXd measured(std::ssize(signals.measured));
  for (std::size_t i = 0; i < signals.samples(); ++i) {
    for (Eigen::Index o = 0; o < measured.size(); ++o) measured[o] = std::isfinite(signals.measured[o].values[i]) ? 1.0 : 0.0;
    together.add(measured);
  }
  return together.have_own_clocks();
}

double own_step(const Signals& signals, std::size_t channel) {
  std::vector<double> t;
  for (std::size_t i = 0; i < signals.samples(); ++i) {
    if (std::isfinite(signals.measured[channel].values[i])) t.push_back(signals.t[i]);
  }
  return usual_step(t.size() > 1 ? t : signals.t);
}

double step_of_measurements(const Signals& signals) {
  if (!have_own_clocks(signals)) return usual_step(signals.t);
  double out = std::numeric_limits<double>::infinity();
  for (std::size_t o = 0; o < signals.measured.size(); ++o) out = std::min(out, own_step(signals, o));
  return out;
}

}  // namespace misfit
