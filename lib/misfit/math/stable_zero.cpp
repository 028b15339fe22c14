#include "misfit/math/stable_zero.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "misfit/math/covariance.h"
#include "misfit/math/decompositions.h"

namespace misfit {

WeightedPoints sorted(const WeightedPoints& points) {
  std::vector<std::size_t> order(points.x.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return points.x[a] < points.x[b]; });
  WeightedPoints result;
  for (const std::size_t k : order) result.add(points.x[k], points.value[k], points.sigma[k]);
  return result;
}

namespace {

/// Mean of the points of equal x (to 1e-9 of the range); `points` sorted.
WeightedPoints averaged(const WeightedPoints& points) {
  WeightedPoints means;
  const double same = 1e-9 * (points.x.back() - points.x.front());
  for (std::size_t i = 0; i < points.x.size();) {
    std::size_t end = i;
    double weight = 0.0;
    double sum = 0.0;
    for (; end < points.x.size() && points.x[end] - points.x[i] <= same; ++end) {
      const double w = 1.0 / (points.sigma[end] * points.sigma[end]);
      weight += w;
      sum += w * points.value[end];
    }
    means.add(points.x[i], sum / weight, 1.0 / std::sqrt(weight));
    i = end;
  }
  return means;
}

/// Number k of the last pair with value[k] > 0 >= value[k+1], away from x = 0 where an odd curve vanishes anyway.
std::optional<std::size_t> last_stable_bracket(const WeightedPoints& means) {
  for (std::size_t k = means.x.size() - 1; k-- > 0;) {
    if (means.x[k] > 0.0 && means.value[k] > 0.0 && means.value[k + 1] <= 0.0) return k;
  }
  return std::nullopt;
}

struct WeightedPolynomial {
  Eigen::VectorXd c;  ///< in u = x − origin
  Eigen::MatrixXd covariance;
  double origin = 0.0;
  [[nodiscard]] Eigen::VectorXd basis(double x) const {
    Eigen::VectorXd b(c.size());
    for (Eigen::Index k = 0; k < c.size(); ++k) b(k) = std::pow(x - origin, static_cast<double>(k));
    return b;
  }
  [[nodiscard]] double at(double x) const { return basis(x).dot(c); }
  [[nodiscard]] double slope(double x) const { return c(1) + (c.size() > 2 ? 2.0 * c(2) * (x - origin) : 0.0); }
};

WeightedPolynomial fit_polynomial(const WeightedPoints& points, Eigen::Index order, double origin, bool sigmas_known) {
  const auto n = std::ssize(points.x);
  WeightedPolynomial p{Eigen::VectorXd::Zero(order), {}, origin};
  Eigen::MatrixXd A(n, order);
  Eigen::VectorXd b(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t k = i;
    A.row(i) = p.basis(points.x[k]).transpose() / points.sigma[k];
    b(i) = points.value[k] / points.sigma[k];
  }
  const Eigen::MatrixXd normal = A.transpose() * A;
  p.c = symmetric_solve(normal, Eigen::VectorXd(A.transpose() * b));
  const double reduced = n > order ? (A * p.c - b).squaredNorm() / static_cast<double>(n - order) : 0.0;
  p.covariance = inverse(normal) * (sigmas_known ? std::max(1.0, reduced) : reduced);
  return p;
}

double zero_between(const WeightedPolynomial& p, double lo, double hi) {
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (lo + hi);
    (p.at(middle) > 0.0 ? lo : hi) = middle;
  }
  return 0.5 * (lo + hi);
}

WeightedPoints between(const WeightedPoints& points, double lo, double hi) {
  WeightedPoints result;
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    if (points.x[i] >= lo && points.x[i] <= hi) result.add(points.x[i], points.value[i], points.sigma[i]);
  }
  return result;
}

}  // namespace

std::optional<ZeroCrossing> stable_zero(const WeightedPoints& given) {
  if (given.x.size() < 2) return std::nullopt;
  const bool known = std::all_of(given.sigma.begin(), given.sigma.end(), [](double s) { return s > 0.0; });
  const WeightedPoints points = sorted({given.x, given.value, known ? given.sigma : std::vector<double>(given.x.size(), 1.0)});
  const WeightedPoints means = averaged(points);
  const std::optional<std::size_t> bracket = last_stable_bracket(means);
  if (!bracket) return std::nullopt;
  const std::size_t first = *bracket >= 2 ? *bracket - 2 : 0;
  const std::size_t last = std::min(*bracket + 3, means.x.size() - 1);
  const Eigen::Index order = last - first + 1 >= 4 ? 3 : 2;
  const double lo = means.x[*bracket];
  const double hi = means.x[*bracket + 1];
  const WeightedPolynomial p = fit_polynomial(between(points, means.x[first], means.x[last]), order, lo, known);
  const double below = std::max(means.x[first], lo - (hi - lo));  // the smooth curve may cross just outside the bracket of the noisy means
  const double above = std::min(means.x[last], hi + (hi - lo));
  if (!(p.at(below) > 0.0) || !(p.at(above) <= 0.0)) return std::nullopt;
  const double zero = zero_between(p, below, above);
  const double slope = p.slope(zero);
  if (!(slope < 0.0)) return std::nullopt;
  const Eigen::VectorXd g = p.basis(zero) / slope;
  return ZeroCrossing{zero, standard_error_of_sum(p.covariance, g)};
}

}  // namespace misfit
