#include "misfit/fit/filter/reading.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "misfit/fit/filter/normal_density.h"

namespace misfit {
namespace {

double standard_normal_density(double x) { return std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi); }

/// (1 − Φ(x))/φ(x), x >= 0: Mills' ratio; far out by its continued fraction, where both underflow.
double mills_ratio(double x) {
  constexpr double far = 10.0;
  if (x < far) return std::sqrt(0.5 * std::numbers::pi) * std::exp(0.5 * x * x) * std::erfc(x / std::numbers::sqrt2);
  constexpr int terms = 12;
  double tail = x;
  for (int k = terms; k > 0; --k) tail = x + k / tail;
  return 1.0 / tail;
}

/// p and φ/p at both ends of an interval [a, b].
struct Ends {
  double log_p, at_a, at_b;
};

Ends around_zero(double a, double b) {
  const double p = 0.5 * (std::erf(b / std::numbers::sqrt2) - std::erf(a / std::numbers::sqrt2));
  return {std::log(p), standard_normal_density(a) / p, standard_normal_density(b) / p};
}

/// 0 < a < b: p = φ(a) (M(a) − E M(b)) with Mills' ratio M and E = φ(b)/φ(a).
Ends above_zero(double a, double b) {
  const double E = std::exp(-0.5 * (b - a) * (b + a));
  const double ratio = mills_ratio(a) - E * mills_ratio(b);
  return {-0.5 * a * a - 0.5 * std::log(2.0 * std::numbers::pi) + std::log(ratio), 1.0 / ratio, E / ratio};
}

}  // namespace

Reading read_as_it_is(double departure, double S) { return {departure, S, minus_log_normal(departure, S)}; }

Reading read_in_steps(double departure, double S, double step) {
  constexpr double fine = 1e-3;    // of a sigma: what follows is a difference of numbers that are nearly equal
  constexpr double least = 1e-12;  // of k: a prediction much sharper than the step learns nothing
  const double sigma = std::sqrt(S);
  if (!(step > fine * sigma)) return read_as_it_is(departure, S + step * step / 12.0);
  const double side = departure < 0.0 ? -1.0 : 1.0;
  const double a = (std::abs(departure) - 0.5 * step) / sigma, b = (std::abs(departure) + 0.5 * step) / sigma;
  const auto [log_p, at_a, at_b] = a > 0.0 ? above_zero(a, b) : around_zero(a, b);
  const double m = at_a - at_b;
  const double k = std::clamp(m * m + b * at_b - a * at_a, least, 1.0);
  return {side * sigma * m / k, S / k, std::log(step) - log_p};
}

}  // namespace misfit
