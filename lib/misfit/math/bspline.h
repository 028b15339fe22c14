#pragma once

// References
//   [dB] C. de Boor, A Practical Guide to Splines (2001), ch. IX: B-spline recurrence.
//   [OS] F. O'Sullivan, Statist. Sci. 1 (1986): penalised B-splines with the integrated squared second derivative.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "misfit/core/lists.h"

namespace misfit {

/// Symmetry of a curve about 0 of its argument: C_m is odd in alpha_T, C_mq even, most curves have none.
enum class Parity { none, odd, even };

/// Weights of the four B-splines that are not zero at a point: value = Σ w[j] c[first + j], slope = Σ d[j] c[first + j].
struct CurvePoint {
  std::array<double, 4> w{};
  std::array<double, 4> d{};
  int first = 0;
};

/// Cubic B-spline basis on simple interior knots with coalescent ends [dB]: `knots` breakpoints give knots + 2 coefficients.
///
/// Continuation outside the knots, so that a wandering solver meets a finite, once differentiable curve:
///   above the last knot: straight line with the end slope;
///   below the first knot k: straight line (Parity::none); a x + b x³ (odd) or a + b x² (even) with value and slope matched at k > 0, and
///   the mirror image for x < 0.
/// Parities need k > 0: the constructor drops a first breakpoint at 0 (the continuation covers [0, k] with value 0 or slope 0 at 0).
class CubicSpline {
 public:
  CubicSpline() = default;
  /// At least two strictly increasing breakpoints remain, else InputError.
  explicit CubicSpline(std::vector<double> breakpoints, Parity parity = Parity::none);

  [[nodiscard]] int size() const { return int_size(knots_) + 2; }
  [[nodiscard]] const std::vector<double>& breakpoints() const { return knots_; }
  [[nodiscard]] Parity parity() const { return parity_; }
  [[nodiscard]] double lowest() const { return knots_.front(); }
  [[nodiscard]] double highest() const { return knots_.back(); }

  /// Weights at x. Never indexes outside the coefficients, whatever x is; a NaN gives NaN weights.
  [[nodiscard]] CurvePoint at(double x) const {
    CurvePoint out;
    evaluate(x, out);
    return out;
  }
  /// The same in place: the inner loop should not copy.
  void evaluate(double x, CurvePoint& out) const {
    if (!covers(x)) {
      out = outside(x);
      return;
    }
    const int interval = interval_of(x);
    inside(interval, x - knots_[interval], out);
  }
  /// True where both have the same weights at every x inside the knots (parity differs only outside).
  [[nodiscard]] bool same_inside(const CubicSpline& other) const { return knots_ == other.knots_; }
  [[nodiscard]] bool covers(double x) const { return x >= knots_.front() && x < knots_.back(); }
  /// Weights of C(x)/sin(x) and its derivative, regular at 0 for an odd curve: there C/sin = (a + b x²) x/sin x.
  [[nodiscard]] CurvePoint over_sine(double x) const;

  /// Roughness ∫ C''(x)² dx = cᵀ Ω c over the knots, exact (C'' is piecewise linear) [OS]. Unit: value² / argument³.
  [[nodiscard]] Eigen::MatrixXd roughness() const;

  /// Coefficients of a straight line value0 + slope (x − x0): the Greville abscissae carry it exactly [dB].
  [[nodiscard]] Eigen::VectorXd line(double x0, double value0, double slope) const;
  /// Mean of the three inner knots of each coefficient: where it mostly acts.
  [[nodiscard]] std::vector<double> greville() const;

 private:
  [[nodiscard]] CurvePoint inside(int interval, double u) const {
    CurvePoint out;
    inside(interval, u, out);
    return out;
  }
  void inside(int interval, double u, CurvePoint& out) const {
    const Piece& p = pieces_[interval];
    std::array<double, 4> w, d;  // not in `out` at once: the compiler must not fear that it is the piece
    for (std::size_t j = 0; j < 4; ++j) {
      w[j] = ((p[3][j] * u + p[2][j]) * u + p[1][j]) * u + p[0][j];
      d[j] = (3.0 * p[3][j] * u + 2.0 * p[2][j]) * u + p[1][j];
    }
    out.first = interval;
    out.w = w;
    out.d = d;
  }
  /// Only for x inside the knots.
  [[nodiscard]] int interval_of(double x) const {
    const auto cell = static_cast<std::size_t>((x - knots_.front()) * cells_per_unit_);
    int i = lookup_[cell < lookup_.size() ? cell : lookup_.size() - 1];
    while (x >= knots_[i + 1]) ++i;
    while (x < knots_[i]) --i;
    return i;
  }
  [[nodiscard]] CurvePoint outside(double x) const;
  [[nodiscard]] CurvePoint below(double x) const;

  using Piece = std::array<std::array<double, 4>, 4>;  ///< [power][basis]: basis_j(x) = Σ_p piece[p][j] (x − knot)^p
  std::vector<double> knots_;
  std::vector<Piece> pieces_;
  std::vector<int> lookup_;  ///< first interval of each of equal cells, to find an interval without a search
  double cells_per_unit_ = 0.0;
  Parity parity_ = Parity::none;
};

}  // namespace misfit
