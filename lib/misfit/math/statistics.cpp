#include "misfit/math/statistics.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <utility>

namespace misfit {
namespace {
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
}  // namespace

double median(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  if (values.empty()) return nan_value;
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

double resolution_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  constexpr std::size_t fewest = 3;
  if (values.size() < fewest) return 0.0;
  double least = values.back() - values.front();
  const double noise = 1e-9 * std::max(std::abs(values.front()), std::abs(values.back()));
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (values[i] - values[i - 1] > noise) least = std::min(least, values[i] - values[i - 1]);
  }
  if (!((values.back() - values.front()) / least < 1e7)) return 0.0;
  // Counted from each value to the next, where the digits lost in printing do not add up.
  std::vector<double> steps(values.size());
  for (std::size_t i = 1; i < values.size(); ++i) steps[i] = steps[i - 1] + std::round((values[i] - values[i - 1]) / least);
  if (!(steps.back() > 0.0)) return 0.0;  // they differ by rounding alone
  const double step = (values.back() - values.front()) / steps.back();
  for (std::size_t i = 0; i < values.size(); ++i) {
    constexpr double whole = 0.02;
    if (std::abs(values[i] - values.front() - steps[i] * step) > whole * step) return 0.0;
  }
  return step;
}

double repeat_share(const std::vector<double>& values) {
  std::size_t equal = 0, pairs = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    if (!std::isfinite(values[i]) || !std::isfinite(values[i - 1])) continue;
    ++pairs;
    equal += values[i] == values[i - 1] ? 1U : 0U;
  }
  return pairs == 0 ? 0.0 : static_cast<double>(equal) / static_cast<double>(pairs);
}

bool MeanAndSigma::constant() const {
  constexpr double rounding = 1e-12;
  return !(sigma > rounding * std::abs(mean));
}

MeanAndSigma mean_and_sigma(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0, n = 0.0;
  for (const double v : values) {
    if (std::isfinite(v)) sum += v, n += 1.0;
  }
  if (n == 0.0) return {};
  const double mean = sum / n;
  for (const double v : values) {
    if (std::isfinite(v)) squares += (v - mean) * (v - mean);
  }
  return {mean, std::sqrt(squares / n)};
}

double standard_deviation(const std::vector<double>& values) { return mean_and_sigma(values).sigma; }

double usual_step(const std::vector<double>& t) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < t.size(); ++i) steps.push_back(t[i] - t[i - 1]);
  return steps.empty() ? 1.0 : median(steps);
}

double mad_sigma(const std::vector<double>& values) {
  const double centre = median(values);
  std::vector<double> deviations;
  deviations.reserve(values.size());
  for (const double v : values) deviations.push_back(std::abs(v - centre));
  return 1.482602218505602 * median(std::move(deviations));
}

double largest_usual_sigma(std::vector<double> sigma) {
  constexpr double ratio = 10.0;
  const double usual = median(std::move(sigma));
  return std::isnan(usual) ? std::numeric_limits<double>::infinity() : ratio * usual;
}

double chi_square_tail(double x, double dof) {
  if (std::isnan(x)) return nan_value;
  if (x <= 0.0) return 1.0;
  if (std::isinf(x)) return 0.0;
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(dof), x));
}

double log_chi_square_tail(double x, double dof) {
  const double p = chi_square_tail(x, dof);
  if (p > 1e-290) return std::log(p);
  // Leading term of the upper incomplete gamma function: (x/2)^(dof/2 − 1) e^(−x/2)/Γ(dof/2).
  return (0.5 * dof - 1.0) * std::log(0.5 * x) - 0.5 * x - std::lgamma(0.5 * dof);
}

double f_tail(double x, double dof1, double dof2) {
  if (std::isnan(x)) return nan_value;
  if (x <= 0.0) return 1.0;
  if (std::isinf(x)) return 0.0;
  return boost::math::cdf(boost::math::complement(boost::math::fisher_f(dof1, dof2), x));
}

double normal_quantile(double p) { return boost::math::quantile(boost::math::normal(), p); }

double student_quantile(double p, double dof) { return boost::math::quantile(boost::math::students_t(dof), p); }

double normal_tail(double x) { return 0.5 * std::erfc(x / std::sqrt(2.0)); }

double sidak(double p, double count) { return p >= 1.0 ? 1.0 : -std::expm1(count * std::log1p(-p)); }

}  // namespace misfit
