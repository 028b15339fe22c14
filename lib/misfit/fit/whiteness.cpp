#include "misfit/fit/whiteness.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/math/statistics.h"

namespace misfit {

std::vector<double> autocorrelation(const std::vector<double>& residuals, int max_lag) {
  double sum = 0.0, count = 0.0;
  for (double r : residuals) {
    if (std::isfinite(r)) sum += r, count += 1.0;
  }
  const double mean = count > 0.0 ? sum / count : 0.0;
  double variance = 0.0;
  for (double r : residuals) {
    if (std::isfinite(r)) variance += (r - mean) * (r - mean);
  }
  variance /= std::max(count, 1.0);
  std::vector<double> rho;
  for (int lag = 0; lag <= max_lag; ++lag) {
    double product = 0.0, pairs = 0.0;
    for (auto i = static_cast<std::size_t>(lag); i < residuals.size(); ++i) {
      const double p = (residuals[i] - mean) * (residuals[i - static_cast<std::size_t>(lag)] - mean);
      if (std::isfinite(p)) product += p, pairs += 1.0;
    }
    constexpr double least_pairs = 10.0;
    rho.push_back(pairs >= least_pairs && variance > 0.0 ? product / pairs / variance : std::numeric_limits<double>::quiet_NaN());
  }
  return rho;
}

WhitenessTest whiteness(const std::vector<double>& residuals, int first_lag, int last_lag) {
  WhitenessTest test;
  test.first_lag = first_lag;
  test.last_lag = std::max(first_lag, last_lag);
  const std::vector<double> rho = autocorrelation(residuals, test.last_lag);
  const auto n = static_cast<double>(std::count_if(residuals.begin(), residuals.end(), [](double r) { return std::isfinite(r); }));
  double degrees = 0.0;
  for (int lag = first_lag; lag <= test.last_lag; ++lag) {
    const double r = rho[static_cast<std::size_t>(lag)];
    if (!std::isfinite(r) || n <= lag) continue;
    test.statistic += n * (n + 2.0) * r * r / (n - lag);
    degrees += 1.0;
    if (std::abs(r) > std::abs(test.largest)) {
      test.largest = r;
      test.largest_lag = lag;
    }
  }
  if (degrees > 0.0) test.p_value = chi_square_tail(test.statistic, degrees);
  return test;
}

bool looks_driven(const WhitenessTest& test) { return test.p_value < 1e-6 && std::abs(test.largest) > 0.15; }

}  // namespace misfit
