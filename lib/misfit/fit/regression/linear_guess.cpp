#include "misfit/fit/regression/linear_guess.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>

#include "misfit/math/statistics.h"

namespace misfit {
namespace {

struct Spread {
  double mean = 0.0, sigma = 0.0;
};

Spread spread_of(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    sum += v;
    ++count;
  }
  const double mean = count > 0.0 ? sum / count : 0.0;
  for (const double v : values) {
    if (std::isfinite(v)) squares += (v - mean) * (v - mean);
  }
  return {mean, count > 0.0 ? std::sqrt(squares / count) : 0.0};
}

/// Crossings of the mean, counted once the value has been 0.3 sigma beyond it on either side.
std::size_t crossings(const std::vector<double>& y, const Spread& spread) {
  constexpr double beyond = 0.3;
  std::size_t count = 0;
  int side = 0;
  for (const double v : y) {
    const double away = v - spread.mean;
    const int now = away > beyond * spread.sigma ? 1 : away < -beyond * spread.sigma ? -1 : 0;
    if (now == 0) continue;
    count += side != 0 && now != side ? 1U : 0U;
    side = now;
  }
  return count;
}

struct Regression {
  double a1 = 0.0, a2 = 0.0, constant = 0.0;
  std::vector<double> inputs;
};

/// Means of an input over stretches of rows.
class Means {
 public:
  explicit Means(const std::vector<double>& u) : sum_(u.size() + 1, 0.0), count_(u.size() + 1, 0.0) {
    for (std::size_t k = 0; k < u.size(); ++k) {
      const bool known = std::isfinite(u[k]);
      sum_[k + 1] = sum_[k] + (known ? u[k] : 0.0);
      count_[k + 1] = count_[k] + (known ? 1.0 : 0.0);
    }
  }
  /// Over rows from … to − 1; NaN if none is known.
  [[nodiscard]] double operator()(std::size_t from, std::size_t to) const { return (sum_[to] - sum_[from]) / (count_[to] - count_[from]); }

 private:
  std::vector<double> sum_, count_;
};

/// y(k) = a1 y(k − d) + a2 y(k − 2d) + Σ (c1 u1 + c2 u2) + constant, u1 and u2 the means of an input over the last d rows and those before
/// (an input may change many times between the rows compared), over the rows where nothing is missing and no gap lies between.
std::optional<Regression> regress(const GuessData& data, std::size_t d, double step, const Spread& spread) {
  const auto inputs = static_cast<Eigen::Index>(data.inputs.size());
  const Eigen::Index n = 3 + 2 * inputs;
  std::vector<Means> means;
  for (const auto& u : data.inputs) means.emplace_back(u);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n), row(n);
  Eigen::Index rows = 0;
  const double expected = step * static_cast<double>(d);
  constexpr double tolerance = 0.2;
  for (std::size_t k = 2 * d; k < data.t.size(); ++k) {
    const double first = data.t[k - d] - data.t[k - 2 * d], second = data.t[k] - data.t[k - d];
    if (std::abs(first - expected) > tolerance * expected || std::abs(second - expected) > tolerance * expected) continue;
    row[0] = (data.y[k - d] - spread.mean) / spread.sigma;
    row[1] = (data.y[k - 2 * d] - spread.mean) / spread.sigma;
    row[2] = 1.0;
    for (Eigen::Index i = 0; i < inputs; ++i) {
      const Means& mean = means[i];
      row[3 + 2 * i] = mean(k - d, k);
      row[4 + 2 * i] = mean(k - 2 * d, k - d);
    }
    const double y = (data.y[k] - spread.mean) / spread.sigma;
    if (!row.allFinite() || !std::isfinite(y)) continue;
    normal.noalias() += row * row.transpose();
    right += y * row;
    ++rows;
  }
  if (rows < 4 * n) return std::nullopt;
  const Eigen::VectorXd solved = normal.completeOrthogonalDecomposition().solve(right);
  if (!solved.allFinite()) return std::nullopt;
  Regression out{solved[0], solved[1], solved[2] * spread.sigma, {}};
  for (Eigen::Index i = 3; i < n; i += 2) out.inputs.push_back((solved[i] + solved[i + 1]) * spread.sigma);
  return out;
}

/// Gains and rest of the static answer.
void set_static(const Regression& r, const Spread& spread, LinearGuess& out) {
  const double answer = 1.0 - r.a1 - r.a2;
  for (std::size_t i = 0; i < r.inputs.size(); ++i) out.gain[i] = r.inputs[i] / answer;
  out.rest = spread.mean + r.constant / answer;
}

}  // namespace

LinearGuess guess_linear(const GuessData& data) {
  LinearGuess out;
  out.gain.assign(data.inputs.size(), 0.0);
  const Spread spread = spread_of(data.y);
  out.rest = spread.mean;
  const double length = data.t.back() - data.t.front();
  out.tau = 0.1 * length;
  out.why = "no linear model could be estimated from the data: tau is a tenth of the record";
  if (!(spread.sigma > 0.0) || data.t.size() < 3) return out;
  std::vector<double> steps;
  for (std::size_t k = 1; k < data.t.size(); ++k) steps.push_back(data.t[k] - data.t[k - 1]);
  const double step = median(steps);
  const double swing = 2.0 * length / static_cast<double>(std::max<std::size_t>(crossings(data.y, spread), 1));
  constexpr double samples_per_period = 10.0;
  const auto d = static_cast<std::size_t>(
      std::clamp(std::round(swing / samples_per_period / step), 1.0, static_cast<double>(data.t.size()) / 20.0 + 1.0));
  const auto r = regress(data, d, step, spread);
  if (!r) return out;
  const double h = step * static_cast<double>(d);
  const std::complex<double> root = std::sqrt(std::complex<double>(0.25 * r->a1 * r->a1 + r->a2));
  const std::complex<double> slow = 0.5 * r->a1 + root;
  if (!(std::abs(slow) < 1.02) || std::abs(slow) < 1e-6) return out;
  const std::complex<double> pole = std::log(slow) / h;
  const double omega = std::abs(pole), zeta = -pole.real() / omega;
  constexpr double max_damping_ratio = 0.9;
  if (std::abs(slow.imag()) > 1e-9 && zeta < max_damping_ratio) {
    out.order = 2;
    out.stiffness = omega * omega;
    out.damping = std::max(2.0 * zeta * omega, 1e-3 * omega);
    set_static(*r, spread, out);
    out.why = fmt::format("oscillatory: natural frequency about {:.3g} Hz, damping ratio {:.3g}", omega / (2.0 * std::numbers::pi),
                          std::max(zeta, 0.0));
    return out;
  }
  const double modulus = std::abs(slow);
  if (!(slow.real() > 0.0) || !(modulus < 0.9999)) return out;
  out.tau = -h / std::log(modulus);
  set_static(*r, spread, out);
  out.why = fmt::format("not oscillatory: time constant about {:.3g} s", out.tau);
  return out;
}

}  // namespace misfit
