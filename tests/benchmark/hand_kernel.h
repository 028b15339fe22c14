#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <vector>

#include "misfit/math/bspline.h"

namespace misfit::benchmark_data {

/// What a careful person writes for one model and nothing else: Eq. 8 with two cubic-spline curves, RK4 over the sample interval,
/// sensitivities of both states for 2 × coefficients + 2 initial values propagated through the stages, normal equations accumulated on the
/// way. The yardstick for the general mechanism.
template <int Coefficients>
class HandKernel {
 public:
  static constexpr int columns = 2 * Coefficients + 2;
  using Row = Eigen::Matrix<double, 1, columns>;
  using Normal = Eigen::Matrix<double, columns, columns>;

  HandKernel(const CubicSpline& spline, double gain, double lever) : spline_(spline), gain_(gain), lever_(lever) {}

  /// Returns the residual sum of squares; N and g are set.
  double linearise(const std::vector<double>& t, const std::vector<double>& y, double sigma, const std::array<double, 2>& x0,
                   const double* C_m, const double* C_d, Normal& N, Row& g) const {
    N.setZero();
    g.setZero();
    double x = x0[0], v = x0[1], rss = 0.0;
    Row Sx = Row::Zero(), Sv = Row::Zero();
    Sx[columns - 2] = 1.0;
    Sv[columns - 1] = 1.0;
    const double weight = 1.0 / sigma;
    for (std::size_t i = 0; i < t.size(); ++i) {
      const double r = (x - y[i]) * weight;
      rss += r * r;
      const Row J = weight * Sx;
      N.template selfadjointView<Eigen::Lower>().rankUpdate(J.transpose());
      g += r * J;
      if (i + 1 < t.size()) step(t[i + 1] - t[i], C_m, C_d, x, v, Sx, Sv);
    }
    N.template triangularView<Eigen::StrictlyUpper>() = N.transpose();
    return rss;
  }

 private:
  struct Slope {
    double dx, dv;
    Row Kx, Kv;
  };

  void rhs(double x, double v, const Row& Sx, const Row& Sv, const double* C_m, const double* C_d, Slope& k) const {
    const CurvePoint p = spline_.at(x);
    double m = 0.0, m_slope = 0.0, d = 0.0, d_slope = 0.0;
    for (std::size_t j = 0; j < 4; ++j) {
      const auto c = static_cast<std::size_t>(p.first) + j;
      m += p.w[j] * C_m[c];
      m_slope += p.d[j] * C_m[c];
      d += p.w[j] * C_d[c];
      d_slope += p.d[j] * C_d[c];
    }
    k.dx = v;
    k.dv = gain_ * (m + lever_ * d * v);
    const double by_x = gain_ * (m_slope + lever_ * d_slope * v), by_v = gain_ * lever_ * d;
    k.Kx = Sv;
    k.Kv = by_x * Sx + by_v * Sv;
    for (int j = 0; j < 4; ++j) {
      k.Kv[p.first + j] += gain_ * p.w[static_cast<std::size_t>(j)];
      k.Kv[Coefficients + p.first + j] += gain_ * lever_ * v * p.w[static_cast<std::size_t>(j)];
    }
  }

  void step(double h, const double* C_m, const double* C_d, double& x, double& v, Row& Sx, Row& Sv) const {
    Slope a, b, c, d;
    rhs(x, v, Sx, Sv, C_m, C_d, a);
    rhs(x + 0.5 * h * a.dx, v + 0.5 * h * a.dv, Sx + 0.5 * h * a.Kx, Sv + 0.5 * h * a.Kv, C_m, C_d, b);
    rhs(x + 0.5 * h * b.dx, v + 0.5 * h * b.dv, Sx + 0.5 * h * b.Kx, Sv + 0.5 * h * b.Kv, C_m, C_d, c);
    rhs(x + h * c.dx, v + h * c.dv, Sx + h * c.Kx, Sv + h * c.Kv, C_m, C_d, d);
    x += h / 6.0 * (a.dx + 2.0 * b.dx + 2.0 * c.dx + d.dx);
    v += h / 6.0 * (a.dv + 2.0 * b.dv + 2.0 * c.dv + d.dv);
    Sx += h / 6.0 * (a.Kx + 2.0 * b.Kx + 2.0 * c.Kx + d.Kx);
    Sv += h / 6.0 * (a.Kv + 2.0 * b.Kv + 2.0 * c.Kv + d.Kv);
  }

  const CubicSpline& spline_;
  double gain_, lever_;
};

}  // namespace misfit::benchmark_data
