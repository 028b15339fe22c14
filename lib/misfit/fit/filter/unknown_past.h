#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <vector>

#include "misfit/fit/filter/filter_run.h"
#include "misfit/fit/filter/kalman.h"
#include "misfit/model/memory.h"

namespace misfit {

/// What inputs were before the recording began, where effects read that (Reads::late()): nobody knows. A deviation c from its first value
/// for each input, constant in time, a priori 0 with the RMS departure of the input from there as sigma. It is estimated beside the state,
/// by the innovations, as long as the past is reached, and then left out; a recording that begins at rest when its input has just been
/// switched on would otherwise put what the delay does not explain into the state, or into another effect. M, NY as in Kalman.
template <int M, int NY>
class UnknownPast {
 public:
  using K = Kalman<M, NY>;
  using StateVector = typename K::StateVector;

  UnknownPast(const FilterModel& model, const FilterData& data, int states, int channels) {
    const auto& effects = model.model.effects;
    const bool late = std::any_of(effects.begin(), effects.end(), [](const BoundEffect& e) { return reads_the_past(e.effect->spec()); });
    if (!late) return;
    for (std::size_t i = 0; i < data.input_departures.size(); ++i) {
      if (data.input_departures[i] > 0.0) inputs_.push_back({static_cast<int>(i), data.input_departures[i]});
    }
    const Eigen::Index count = std::ssize(inputs_);
    X_.setZero(states, count);
    J_.setZero(2 * static_cast<Eigen::Index>(channels), count);
    G_.setZero(states, count);
    V_.setZero(count, count);
    for (Eigen::Index c = 0; c < count; ++c) V_(c, c) = inputs_[c].sigma * inputs_[c].sigma;
    gain_.setZero(count);
    reached_ = count > 0;
  }

  [[nodiscard]] int count() const { return static_cast<int>(inputs_.size()); }
  /// Does what comes depend on it?
  [[nodiscard]] bool is_reached() const { return reached_; }
  /// Estimated deviations from the first values, of each input of the system; nullptr: nothing depends on them.
  [[nodiscard]] const double* before() const { return reached_ ? mean_.data() : nullptr; }
  /// ∂(state after the step)/∂c.
  [[nodiscard]] const auto& response() const { return G_; }
  /// Of the last update.
  [[nodiscard]] const auto& gain() const { return gain_; }

  /// Before a step from `x`: response(), by steps with another past. False: the state cannot be carried on.
  [[nodiscard]] bool look_ahead(Stepper& stepper, const double* x, Interval interval) {
    if (!reached_) return true;
    std::array<double, kMaxInputs> past = mean_;
    std::array<double, kMaxStates> from{}, other{};
    const auto n = static_cast<std::size_t>(X_.rows());
    interval.u0.before = past.data();
    std::copy_n(x, n, from.begin());
    if (!stepper.step(from.data(), interval)) return false;
    reached_ = false;
    for (Eigen::Index c = 0; c < G_.cols(); ++c) {
      past[inputs_[c].index] = mean_[inputs_[c].index] + inputs_[c].sigma;
      std::copy_n(x, n, other.begin());
      if (!stepper.step(other.data(), interval)) return false;
      past[inputs_[c].index] = mean_[inputs_[c].index];
      for (std::size_t i = 0; i < n; ++i) G_(i, c) = (other[i] - from[i]) / inputs_[c].sigma;
      reached_ = reached_ || !G_.col(c).isZero(0.0);
    }
    return true;
  }

  /// After look_ahead(), for recall().
  void keep(FilterTrace& trace) const {
    if (!reached_) return;
    trace.past_response.insert(trace.past_response.end(), G_.data(), G_.data() + G_.size());
    for (const PastInput& input : inputs_) trace.past_mean.push_back(mean_[input.index]);
  }
  /// Instead of look_ahead(), at the step of this number (0: the first) in a run about `trace`: adds to `shift` what the past does to the
  /// state after it, being estimated otherwise here than there.
  void recall(const FilterTrace& trace, std::size_t step, StateVector& shift) {
    const auto size = static_cast<std::size_t>(G_.size()), count = inputs_.size();
    reached_ = reached_ && (step + 1) * size <= trace.past_response.size();
    if (!reached_) return;
    std::copy_n(trace.past_response.data() + step * size, size, G_.data());
    for (std::size_t c = 0; c < count; ++c) shift += G_.col(c) * (mean_[inputs_[c].index] - trace.past_mean[step * count + c]);
  }

  /// After Kalman::predict() with the same Φ: [x | e | c] jointly, c constant.
  template <class Phi>
  void predict(const Phi& phi, const NoiseStep& noise, K& kalman) {
    if (!reached_) return;
    const Across turned = phi.lazyProduct(X_), by_variance = G_.lazyProduct(V_);
    kalman.P += turned.lazyProduct(G_.transpose());
    kalman.P += G_.lazyProduct(turned.transpose());
    kalman.P += by_variance.lazyProduct(G_.transpose());
    for (std::size_t o = 0; o < noise.coloured.size(); ++o) {
      const auto& p = noise.coloured[o].phi;
      const Eigen::Index at = 2 * static_cast<Eigen::Index>(o);
      const PastVector first = J_.row(at).transpose(), second = J_.row(at + 1).transpose();
      J_.row(at) = (p[0] * first + p[1] * second).transpose();
      J_.row(at + 1) = (p[2] * first + p[3] * second).transpose();
    }
    kalman.C += G_.lazyProduct(J_.transpose());
    X_ = turned + by_variance;
  }

  /// After Kalman::update() by a measurement of channel o with the row `a` of ∂h/∂x.
  void update(const StateVector& a, int o, const K& kalman, double innovation, double S) {
    if (!reached_) return;
    const PastVector shared = X_.transpose().lazyProduct(a) + J_.row(2 * static_cast<Eigen::Index>(o)).transpose();
    gain_ = shared / S;
    X_ -= kalman.gain.lazyProduct(shared.transpose());
    J_ -= kalman.gain_coloured.lazyProduct(shared.transpose());
    V_ -= gain_.lazyProduct(shared.transpose());
    for (Eigen::Index c = 0; c < gain_.size(); ++c) mean_[inputs_[c].index] += gain_[c] * innovation;
  }

 private:
  struct PastInput {
    int index;
    double sigma;
  };
  using PastVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxInputs, 1>;
  using Across = Eigen::Matrix<double, M, Eigen::Dynamic, Eigen::ColMajor, K::MM, kMaxInputs>;
  using ColouredAcross = Eigen::Matrix<double, K::J, Eigen::Dynamic, Eigen::ColMajor, K::MJ, kMaxInputs>;

  std::vector<PastInput> inputs_;
  bool reached_ = false;
  std::array<double, kMaxInputs> mean_{};
  Across X_, G_;      ///< covariance of x and c; response
  ColouredAcross J_;  ///< covariance of the coloured noise and c
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxInputs, kMaxInputs> V_;
  PastVector gain_;
};

}  // namespace misfit
