#include "misfit/math/bspline.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/error.h"
#include "misfit/core/lists.h"

namespace misfit {
namespace {

using Polynomial = std::array<double, 4>;  // in u = x − left end of the interval

// a·p(u) + (b + c·u)·q(u), cubic at most by construction of the recurrence.
Polynomial add_times_linear(const Polynomial& p, const Polynomial& q, double constant, double slope) {
  Polynomial out = p;
  for (std::size_t k = 0; k < 4; ++k) out[k] += constant * q[k];
  for (std::size_t k = 0; k < 3; ++k) out[k + 1] += slope * q[k];
  return out;
}

// The four cubic B-splines on [knots[i], knots[i+1]] as polynomials of u (de Boor's recurrence on polynomials).
std::array<Polynomial, 4> basis_polynomials(const std::vector<double>& extended, std::size_t left) {
  std::array<Polynomial, 4> basis{};
  basis[0] = {1.0, 0.0, 0.0, 0.0};
  const double origin = extended[left];
  for (std::size_t order = 1; order <= 3; ++order) {
    std::array<Polynomial, 4> next{};
    for (std::size_t j = 0; j < order; ++j) {  // basis j of lower order starts at knot left − order + 1 + j
      const double start = extended[left - order + 1 + j];
      const double end = extended[left + 1 + j];
      const double inverse = 1.0 / (end - start);
      next[j] = add_times_linear(next[j], basis[j], (end - origin) * inverse, -inverse);
      next[j + 1] = add_times_linear(next[j + 1], basis[j], (origin - start) * inverse, inverse);
    }
    basis = next;
  }
  return basis;
}

std::vector<double> extended_knots(const std::vector<double>& knots) {
  std::vector<double> extended(3, knots.front());
  extended.insert(extended.end(), knots.begin(), knots.end());
  extended.insert(extended.end(), 3, knots.back());
  return extended;
}

CurvePoint combine(const CurvePoint& at, double value_w, double value_d, double slope_w, double slope_d) {
  // New value weights = value_w·w + value_d·d; new slope weights = slope_w·w + slope_d·d.
  CurvePoint out;
  out.first = at.first;
  for (std::size_t j = 0; j < 4; ++j) {
    out.w[j] = value_w * at.w[j] + value_d * at.d[j];
    out.d[j] = slope_w * at.w[j] + slope_d * at.d[j];
  }
  return out;
}

}  // namespace

CubicSpline::CubicSpline(std::vector<double> breakpoints, Parity parity) : knots_(std::move(breakpoints)), parity_(parity) {
  if (parity != Parity::none && !knots_.empty() && knots_.front() == 0.0) knots_.erase(knots_.begin());
  if (knots_.size() < 2) throw InputError("a curve needs at least two knots (a first knot at 0 of an odd or even curve does not count)");
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    if (!(knots_[i] > knots_[i - 1])) throw InputError("knots of a curve must increase strictly");
  }
  if (!std::isfinite(knots_.front()) || !std::isfinite(knots_.back())) throw InputError("knots of a curve must be finite");
  if (parity != Parity::none && !(knots_.front() > 0.0)) throw InputError("knots of an odd or even curve must be positive");
  const std::vector<double> extended = extended_knots(knots_);
  for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
    const auto basis = basis_polynomials(extended, i + 3);
    Piece piece{};
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t p = 0; p < 4; ++p) piece[p][j] = basis[j][p];
    }
    pieces_.push_back(piece);
  }
  const std::size_t cells = 4 * pieces_.size();
  cells_per_unit_ = static_cast<double>(cells) / (knots_.back() - knots_.front());
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const double x = knots_.front() + static_cast<double>(cell) / cells_per_unit_;
    const auto next = std::upper_bound(knots_.begin(), knots_.end(), x + 1e-12 * (knots_.back() - knots_.front()));
    lookup_.push_back(std::clamp(static_cast<int>(next - knots_.begin()) - 1, 0, int_size(pieces_) - 1));
  }
}

CurvePoint CubicSpline::below(double x) const {
  const CurvePoint end = inside(0, 0.0);
  const double k = knots_.front();
  if (parity_ == Parity::odd) {  // a x + b x³ with a = (3 v/k − s)/2, b = (s − v/k)/(2 k²)
    const double r = x / k;
    return combine(end, r * (3.0 - r * r) / 2.0, k * r * (r * r - 1.0) / 2.0, (3.0 - 3.0 * r * r) / (2.0 * k), (3.0 * r * r - 1.0) / 2.0);
  }
  if (parity_ == Parity::even) {  // a + b x² with b = s/(2 k), a = v − s k/2
    return combine(end, 1.0, (x * x - k * k) / (2.0 * k), 0.0, x / k);
  }
  return combine(end, 1.0, x - k, 0.0, 1.0);
}

CurvePoint CubicSpline::outside(double x) const {
  if (parity_ != Parity::none && x < 0.0) {
    CurvePoint mirrored = at(-x);
    auto& turned = parity_ == Parity::odd ? mirrored.w : mirrored.d;  // odd: the value changes sign, even: the slope does
    for (double& value : turned) value = -value;
    return mirrored;
  }
  if (x < knots_.front()) return below(x);
  if (!std::isfinite(x) && !(x > 0.0)) return combine(CurvePoint{}, x, x, x, x);
  const int last = int_size(pieces_) - 1;
  const CurvePoint end = inside(last, knots_.back() - knots_[last]);
  return combine(end, 1.0, x - knots_.back(), 0.0, 1.0);
}

CurvePoint CubicSpline::over_sine(double x) const {
  constexpr double tiny = 1e-4;  // below: x/sin x = 1 + x²/6 to 1e-17
  if (parity_ == Parity::odd && std::abs(x) < tiny && std::abs(x) < knots_.front()) {
    const CurvePoint end = inside(0, 0.0);
    const double k = knots_.front();
    const double shape = 1.0 + x * x / 6.0;
    // C/x = a + b x², a = (3 v/k − s)/2, b = (s k − v)/(2 k³)
    const double a_w = 1.5 / k;
    const double b_w = -0.5 / (k * k * k);
    const double b_d = 0.5 / (k * k);
    return combine(end, (a_w + b_w * x * x) * shape, (-0.5 + b_d * x * x) * shape, x * (2.0 * b_w + a_w / 3.0),
                   x * (2.0 * b_d - 0.5 / 3.0));
  }
  const CurvePoint plain = at(x);
  const double inverse = 1.0 / std::sin(x);
  const double cotangent = std::cos(x) * inverse;
  return combine(plain, inverse, 0.0, -cotangent * inverse, inverse);
}

Eigen::MatrixXd CubicSpline::roughness() const {
  Eigen::MatrixXd omega = Eigen::MatrixXd::Zero(size(), size());
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const double h = knots_[i + 1] - knots_[i];
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t k = 0; k < 4; ++k) {  // C'' = 2 p2 + 6 p3 u
        const double a = 2.0 * pieces_[i][2][j], b = 6.0 * pieces_[i][3][j];
        const double c = 2.0 * pieces_[i][2][k], e = 6.0 * pieces_[i][3][k];
        omega(i + j, i + k) += h * (a * c + h * ((a * e + b * c) / 2.0 + h * b * e / 3.0));
      }
    }
  }
  return omega;
}

std::vector<double> CubicSpline::greville() const {
  const std::vector<double> extended = extended_knots(knots_);
  std::vector<double> mean(size());
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = (extended[i + 1] + extended[i + 2] + extended[i + 3]) / 3.0;
  return mean;
}

Eigen::VectorXd CubicSpline::line(double x0, double value0, double slope) const {
  const std::vector<double> places = greville();
  Eigen::VectorXd c(size());
  for (Eigen::Index i = 0; i < c.size(); ++i) c[i] = value0 + slope * (places[i] - x0);
  return c;
}

}  // namespace misfit
