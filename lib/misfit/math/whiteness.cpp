#include "misfit/math/whiteness.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/core/lists.h"
#include "misfit/core/text.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

/// Of the pairs at one lag.
struct Pairs {
  double count = 0.0, product = 0.0;  ///< Σ r_i r_{i+k}
  double earlier = 0.0, later = 0.0;  ///< Σ r_i², Σ r_{i+k}²
};

/// About the mean, of lags 0 … `lags`.
std::vector<Pairs> pairs_of(const std::vector<double>& residuals, std::size_t lags) {
  double sum = 0.0, n = 0.0;
  for (double r : residuals) {
    if (std::isfinite(r)) sum += r, n += 1.0;
  }
  std::vector<double> about_mean, known;  // both 0 where there is none: adds nothing
  for (double r : residuals) {
    known.push_back(std::isfinite(r) ? 1.0 : 0.0);
    about_mean.push_back(std::isfinite(r) ? r - sum / n : 0.0);
  }
  std::vector<Pairs> out(lags + 1);
  for (std::size_t lag = 0; lag <= lags; ++lag) {
    Pairs& pairs = out[lag];
    for (std::size_t i = lag; i < about_mean.size(); ++i) {
      const double earlier = about_mean[i - lag], later = about_mean[i];
      pairs.count += known[i - lag] * known[i];
      pairs.product += earlier * later;
      pairs.earlier += known[i] * earlier * earlier;
      pairs.later += known[i - lag] * later * later;
    }
  }
  return out;
}

constexpr double min_pairs = 10.0;

/// Variance of the statistic over these lags: 2 of each, and what the lags share.
double variance_of(const std::vector<std::size_t>& lags, const std::vector<Pairs>& pairs) {
  double variance = 2.0 * static_cast<double>(lags.size());
  for (const std::size_t j : lags) {
    for (const std::size_t k : lags) {
      if (j != k) variance += 4.0 * pairs[j + k].count / (pairs[0].count * pairs[0].count);
    }
  }
  return variance;
}

/// ρ_k of a series with places for `length` values: Autocorrelation of whiteness.h.
double correlation(const Pairs& all, const Pairs& at_lag, double lag, double length) {
  if (at_lag.count < min_pairs) return not_known;
  if (at_lag.count == length - lag) return all.product > 0.0 ? at_lag.product / all.product : not_known;
  const double scale = std::sqrt(at_lag.earlier * at_lag.later);
  return scale > 0.0 ? (length - lag) / length * at_lag.product / scale : not_known;
}

}  // namespace

std::vector<double> on_even_grid(const std::vector<double>& t, const std::vector<double>& residuals) {
  const double step = usual_step(t);
  const auto most = static_cast<double>(residuals.size());
  std::vector<double> out;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    const double places = i > 0 && step > 0.0 ? std::clamp(std::round((t[i] - t[i - 1]) / step) - 1.0, 0.0, most) : 0.0;
    out.insert(out.end(), static_cast<std::size_t>(places), not_known);
    out.push_back(residuals[i]);
  }
  return out;
}

std::vector<double> joined_series(const std::vector<std::vector<double>>& series) {
  std::size_t values = 0;
  for (const auto& s : series) values += count_finite(s);
  std::vector<double> out;
  for (const auto& s : series) {
    if (!out.empty()) out.insert(out.end(), values, not_known);
    out.insert(out.end(), s.begin(), s.end());
  }
  return out;
}

std::vector<double> autocorrelation(const std::vector<double>& residuals, int max_lag) {
  const auto lags = static_cast<std::size_t>(std::max(max_lag, 0));
  const std::vector<Pairs> pairs = pairs_of(residuals, lags);
  const auto length = static_cast<double>(residuals.size());
  std::vector<double> rho;
  for (const Pairs& at_lag : pairs) rho.push_back(correlation(pairs[0], at_lag, static_cast<double>(rho.size()), length));
  return rho;
}

WhitenessTest whiteness(const std::vector<double>& residuals, int first_lag, int last_lag, double fitted) {
  const auto n = static_cast<double>(count_finite(residuals));
  WhitenessTest test;
  test.first_lag = first_lag;
  test.last_lag = static_cast<int>(std::min({static_cast<double>(std::max(first_lag, last_lag)), n / 4.0, 10.0 + 2.0 * std::sqrt(n)}));
  constexpr double min_values_per_parameter = 10.0;
  if (n < min_values_per_parameter * fitted) test.last_lag = 0;
  if (test.last_lag < first_lag) return test;
  const std::vector<Pairs> pairs = pairs_of(residuals, std::size_t{2} * test.last_lag);
  const auto length = static_cast<double>(residuals.size());
  std::vector<std::size_t> lags;
  for (int lag = first_lag; lag <= test.last_lag; ++lag) {
    const std::size_t k = lag;
    const double rho = correlation(pairs[0], pairs[k], lag, length);
    if (!std::isfinite(rho)) continue;
    const double r = pairs[k].product / pairs[0].product;
    test.statistic += n * (n + 2.0) * r * r / pairs[k].count;
    lags.push_back(k);
    if (std::abs(rho) <= std::abs(test.largest)) continue;
    test.largest = rho;
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
