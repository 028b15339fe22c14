#include "misfit/math/whiteness.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/core/text.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

std::size_t finite_values(const std::vector<double>& values) {
  return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), [](double v) { return std::isfinite(v); }));
}

/// Sums of products by lag, about the mean; lags 0 … `lags`.
std::vector<double> products_of(const std::vector<double>& residuals, std::size_t lags) {
  double sum = 0.0, n = 0.0;
  for (double r : residuals) {
    if (std::isfinite(r)) sum += r, n += 1.0;
  }
  std::vector<double> about_mean;  // 0 where there is none: adds nothing
  for (double r : residuals) about_mean.push_back(std::isfinite(r) ? r - sum / n : 0.0);
  std::vector<double> out;
  for (std::size_t lag = 0; lag <= lags; ++lag) {
    double product = 0.0;
    for (std::size_t i = lag; i < about_mean.size(); ++i) product += about_mean[i] * about_mean[i - lag];
    out.push_back(product);
  }
  return out;
}

/// How many pairs there are of each lag 0 … `lags`.
std::vector<double> pairs_of(const std::vector<double>& residuals, std::size_t lags) {
  const std::size_t length = residuals.size();
  std::vector<double> out(lags + 1, 0.0);
  if (finite_values(residuals) == length) {
    for (std::size_t lag = 0; lag <= lags && lag < length; ++lag) out[lag] = static_cast<double>(length - lag);
    return out;
  }
  std::vector<int> known;
  for (double r : residuals) known.push_back(std::isfinite(r) ? 1 : 0);
  for (std::size_t lag = 0; lag <= lags; ++lag) {
    int count = 0;
    for (std::size_t i = lag; i < length; ++i) count += known[i] * known[i - lag];
    out[lag] = count;
  }
  return out;
}

constexpr double min_pairs = 10.0;

/// Variance of the statistic over these lags: 2 of each, and what the lags share.
double variance_of(const std::vector<std::size_t>& lags, const std::vector<double>& pairs) {
  double variance = 2.0 * static_cast<double>(lags.size());
  for (const std::size_t j : lags) {
    for (const std::size_t k : lags) {
      if (j != k) variance += 4.0 * pairs[j + k] / (pairs[0] * pairs[0]);
    }
  }
  return variance;
}

}  // namespace

std::vector<double> on_even_grid(const std::vector<double>& t, const std::vector<double>& residuals) {
  const double step = usual_step(t);
  const auto most = static_cast<double>(residuals.size());
  std::vector<double> out;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const double places = i > 0 && step > 0.0 ? std::clamp(std::round((t[i] - t[i - 1]) / step) - 1.0, 0.0, most) : 0.0;
    out.insert(out.end(), static_cast<std::size_t>(places), nan_value);
    out.push_back(residuals[i]);
  }
  return out;
}

std::vector<double> joined_series(const std::vector<std::vector<double>>& series) {
  std::size_t values = 0;
  for (const auto& s : series) values += finite_values(s);
  std::vector<double> out;
  for (const auto& s : series) {
    if (!out.empty()) out.insert(out.end(), values, nan_value);
    out.insert(out.end(), s.begin(), s.end());
  }
  return out;
}

std::vector<double> autocorrelation(const std::vector<double>& residuals, int max_lag) {
  const auto lags = static_cast<std::size_t>(std::max(max_lag, 0));
  const std::vector<double> sums = products_of(residuals, lags), pairs = pairs_of(residuals, lags);
  const auto length = static_cast<double>(residuals.size());
  std::vector<double> rho;
  for (std::size_t k = 0; k <= lags; ++k) {
    const double variance = sums[0] / std::max(pairs[0], 1.0);
    const double share = (length - static_cast<double>(k)) / length;  // 1/n before the sum, not 1/(n − k)
    rho.push_back(pairs[k] >= min_pairs && variance > 0.0 ? share * sums[k] / pairs[k] / variance : nan_value);
  }
  return rho;
}

WhitenessTest whiteness(const std::vector<double>& residuals, int first_lag, int last_lag, double fitted) {
  const auto n = static_cast<double>(finite_values(residuals));
  WhitenessTest test;
  test.first_lag = first_lag;
  test.last_lag = static_cast<int>(std::min({static_cast<double>(std::max(first_lag, last_lag)), n / 4.0, 10.0 + 2.0 * std::sqrt(n)}));
  constexpr double min_values_per_parameter = 10.0;
  if (n < min_values_per_parameter * fitted) test.last_lag = 0;
  if (test.last_lag < first_lag) return test;
  const std::vector<double> rho = autocorrelation(residuals, test.last_lag);
  const std::vector<double> pairs = pairs_of(residuals, 2 * test.last_lag);
  const auto length = static_cast<double>(residuals.size());
  std::vector<std::size_t> lags;
  for (int lag = first_lag; lag <= test.last_lag; ++lag) {
    const auto k = static_cast<std::size_t>(lag);
    if (!std::isfinite(rho[k])) continue;
    const double r = rho[k] * pairs[k] / n * length / (length - static_cast<double>(lag));  // sum of products over sum of squares
    test.statistic += n * (n + 2.0) * r * r / pairs[k];
    lags.push_back(k);
    if (std::abs(rho[k]) <= std::abs(test.largest)) continue;
    test.largest = rho[k];
    test.largest_lag = lag;
  }
  if (lags.empty()) return test;
  const auto mean = static_cast<double>(lags.size());
  const double multiple = 0.5 * variance_of(lags, pairs) / mean;
  test.p_value = chi_square_tail(test.statistic / multiple, mean / multiple);
  return test;
}

std::string in_words(const WhitenessTest& test) {
  if (test.last_lag < test.first_lag) return "too few samples to test for autocorrelation";
  return "lags " + std::to_string(test.first_lag) + " to " + std::to_string(test.last_lag) + " samples: largest autocorrelation " +
         format_value(test.largest) + " at lag " + std::to_string(test.largest_lag) + ", Ljung-Box " + p_equals(test.p_value);
}

bool clearly_coloured(const WhitenessTest& test) {
  constexpr double max_p = 1e-3;
  return test.p_value < max_p;
}

bool looks_driven(const WhitenessTest& test) {
  constexpr double max_p = 1e-6, min_autocorrelation = 0.15;
  return test.p_value < max_p && std::abs(test.largest) > min_autocorrelation;
}

}  // namespace misfit
