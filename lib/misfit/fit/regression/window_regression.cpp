#include "misfit/fit/regression/window_regression.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "misfit/inference/states.h"

namespace misfit {

using Wide = long double;
using Row3 = Eigen::Matrix<Wide, 3, 1>;
using Row4 = Eigen::Matrix<Wide, 4, 1>;

/// Σ z zᵀ of z = (g_s (x − centre), g_s, g_d, y) over the equations first … last − 1, and the weighted sum over their correlated pairs.
/// Both ends only move up.
class RunningSums {
 public:
  RunningSums(const BinRegression& regression, const std::vector<double>& rho)
      : all_(regression), rho_(rho), centre_(0.5 * (regression.equations_.front().x + regression.equations_.back().x)) {}

  void move(std::ptrdiff_t first, std::ptrdiff_t last) {
    if (first >= last_) {  // nothing is kept: start clean
      sums_.setZero();
      pairs_.setZero();
      level_ = 0.0L;
      first_ = last_ = first;
    }
    for (; last_ < last; ++last_) change(last_, 1.0L);
    while (first_ < first) {
      ++first_;
      change(first_ - 1, -1.0L);
    }
  }

  [[nodiscard]] BinSolution solve(double spread_needed) const;

 private:
  Row4 row(std::size_t i) const {
    const BinEquation& e = all_.equations_[i];
    return {Wide{e.static_gain} * (Wide{e.x} - Wide{centre_}), e.static_gain, e.damping_gain, e.y};
  }

  /// Enters (sign 1) or takes out (−1) equation i, which is not itself within first_ … last_ − 1 at that moment.
  void change(std::size_t i, Wide sign) {
    const Row4 z = row(i);
    sums_ += sign * z * z.transpose();
    level_ += sign * (Wide{all_.equations_[i].x} - Wide{centre_});
    const Row3 a = z.head<3>();
    for (std::ptrdiff_t lag = 1; lag < std::ssize(rho_); ++lag) {
      for (const std::ptrdiff_t offset : {-lag, lag}) {
        const std::ptrdiff_t j = partner(i, offset);
        if (j < 0) continue;
        const Row3 b = row(j).head<3>();
        pairs_ += sign * Wide{rho_[lag]} * (a * b.transpose() + b * a.transpose());
      }
    }
  }

  /// The equation `offset` samples away in time, if it is inside the window and no gap in time lies between; −1: none.
  [[nodiscard]] std::ptrdiff_t partner(std::size_t i, std::ptrdiff_t offset) const {
    const auto sample = static_cast<std::ptrdiff_t>(all_.equations_[i].sample) + offset;
    if (sample < 0 || sample >= std::ssize(all_.place_)) return -1;
    const std::ptrdiff_t place = all_.place_[sample];
    if (place < first_ || place >= last_) return -1;
    const double apart = std::abs(all_.equations_[i].t - all_.equations_[place].t);
    const double expected = static_cast<double>(std::abs(offset)) * all_.step_;
    return std::abs(apart - expected) > 0.5 * all_.step_ ? -1 : place;
  }

  const BinRegression& all_;
  const std::vector<double>& rho_;
  double centre_;
  std::ptrdiff_t first_ = 0, last_ = 0;
  Eigen::Matrix<Wide, 4, 4> sums_ = Eigen::Matrix<Wide, 4, 4>::Zero();
  Eigen::Matrix<Wide, 3, 3> pairs_ = Eigen::Matrix<Wide, 3, 3>::Zero();
  Wide level_ = 0.0L;
};

BinSolution RunningSums::solve(double spread_needed) const {
  BinSolution out;
  out.count = static_cast<double>(last_ - first_);
  const Wide mean = level_ / static_cast<Wide>(last_ - first_);
  out.level = static_cast<double>(Wide{centre_} + mean);
  Eigen::Matrix<Wide, 4, 4> shift = Eigen::Matrix<Wide, 4, 4>::Identity();
  shift(0, 1) = -mean;  // g_s (x − centre) → g_s (x − mean of the bin): the line's value is then that at the mean
  const Eigen::Matrix<Wide, 4, 4> moved = shift * sums_ * shift.transpose();
  const Eigen::Matrix<Wide, 3, 3> moved_pairs = shift.topLeftCorner<3, 3>() * pairs_ * shift.topLeftCorner<3, 3>().transpose();
  const Eigen::Matrix<Wide, 3, 1> diagonal = moved.diagonal().head<3>();
  constexpr double parameters = 3.0;
  if (!(out.count > parameters) || !(diagonal.minCoeff() > 0.0L)) return out;
  if (!(diagonal[0] > Wide{spread_needed} * Wide{spread_needed} * diagonal[1])) return out;
  const Eigen::Matrix<Wide, 3, 1> scale = diagonal.cwiseSqrt().cwiseInverse();
  const Eigen::Matrix3d N = (scale.asDiagonal() * moved.topLeftCorner<3, 3>() * scale.asDiagonal()).cast<double>();
  const Eigen::Vector3d b = scale.cwiseProduct(moved.col(3).head<3>()).cast<double>();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(N);
  constexpr double singular = 1e-9;  // of columns scaled to length 1
  if (!(eigen.eigenvalues()[0] > singular)) return out;
  const Eigen::Matrix3d inverse = eigen.eigenvectors() * eigen.eigenvalues().cwiseInverse().asDiagonal() * eigen.eigenvectors().transpose();
  const Eigen::Vector3d theta = N.ldlt().solve(b);
  out.residual_variance = std::max(static_cast<double>(moved(3, 3)) - theta.dot(b), 0.0) / (out.count - parameters);
  const Eigen::Matrix3d coloured = N + (scale.asDiagonal() * moved_pairs * scale.asDiagonal()).cast<double>();
  const Eigen::Matrix3d covariance = inverse * coloured * inverse * out.residual_variance;
  const auto sigma = [&](Eigen::Index i) {
    // An estimated ρ need not be positive definite; a bin whose sum it turns negative or nearly so keeps a tenth of its white variance.
    const double white = inverse(i, i) * out.residual_variance;
    return std::sqrt(std::max(covariance(i, i), 0.1 * white)) * static_cast<double>(scale[i]);
  };
  out.slope = theta[0] * static_cast<double>(scale[0]);
  out.value = theta[1] * static_cast<double>(scale[1]);
  out.damping = theta[2] * static_cast<double>(scale[2]);
  out.slope_sigma = sigma(0);
  out.value_sigma = sigma(1);
  out.damping_sigma = sigma(2);
  out.determined = true;
  return out;
}

BinRegression::BinRegression(std::vector<BinEquation> equations) : equations_(std::move(equations)) {
  std::size_t samples = 0;
  std::vector<double> t;
  for (const auto& e : equations_) {
    samples = std::max(samples, e.sample + 1);
    t.push_back(e.t);
  }
  std::sort(t.begin(), t.end());
  step_ = usual_step(t);
  std::sort(equations_.begin(), equations_.end(),
            [](const auto& a, const auto& b) { return a.x < b.x || (a.x == b.x && a.sample < b.sample); });
  place_.assign(samples, -1);
  for (std::size_t i = 0; i < equations_.size(); ++i) place_[equations_[i].sample] = i;
}

SlidBins BinRegression::slide(const BinLayout& layout, const std::vector<double>& rho) const {
  SlidBins out;
  if (equations_.empty()) return out;
  constexpr double spread = 1e-6;  // of the width: less is rounding of a level that stands still
  RunningSums sums(*this, rho);
  const double lowest = std::floor(equations_.front().x / layout.step), highest = equations_.back().x;
  out.too_many = !((highest / layout.step - lowest) < static_cast<double>(SlidBins::most));
  if (out.too_many) return out;
  std::size_t first = 0, last = 0;
  for (double k = lowest;; k += 1.0) {
    const double low = k * layout.step, high = low + layout.width;
    while (first < equations_.size() && equations_[first].x < low) ++first;
    while (last < equations_.size() && equations_[last].x < high) ++last;
    if (last - first >= layout.minimum_samples) {
      sums.move(first, last);
      const BinSolution bin = sums.solve(spread * layout.width);
      if (bin.determined) out.bins.push_back(bin);
      if (!bin.determined) ++out.undetermined;
    } else {
      ++out.too_few;
    }
    if (high > highest) break;
  }
  return out;
}

BinSolution BinRegression::all(const std::vector<double>& rho) const {
  if (equations_.empty()) return {};
  RunningSums sums(*this, rho);
  sums.move(0, equations_.size());
  return sums.solve(0.0);
}

std::vector<double> BinRegression::residuals(const std::vector<BinSolution>& bins, double reach, std::size_t samples) const {
  std::vector<double> out(samples, std::numeric_limits<double>::quiet_NaN());
  std::size_t nearest = 0;
  for (const auto& e : equations_) {
    while (nearest + 1 < bins.size() && std::abs(bins[nearest + 1].level - e.x) <= std::abs(bins[nearest].level - e.x)) ++nearest;
    if (bins.empty() || std::abs(bins[nearest].level - e.x) > reach) continue;
    const BinSolution& bin = bins[nearest];
    out[e.sample] = e.y - e.static_gain * (bin.value + bin.slope * (e.x - bin.level)) - e.damping_gain * bin.damping;
  }
  return out;
}

}  // namespace misfit
