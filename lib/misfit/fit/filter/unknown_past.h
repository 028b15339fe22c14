#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "misfit/fit/filter/filter_run.h"
#include "misfit/fit/filter/kalman.h"

namespace misfit {

/// How far the rows and the columns of a matrix are apart in memory.
struct Strides {
  Eigen::Index row = 1, column = 1;
};

/// What inputs were before the recording began, where effects read that (Reads::late()): nobody knows. A deviation c from its first value
/// for each input, constant in time, a priori 0 with the RMS departure of the input from there as sigma. It is estimated beside the state,
/// by the innovations, as long as the past is reached, and then left out; a recording that begins at rest when its input has just been
/// switched on would otherwise put what the delay does not explain into the state, or into another effect.
class UnknownPast {
 public:
  UnknownPast(const FilterModel& model, const FilterData& data, int states, int channels);

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
  [[nodiscard]] bool look_ahead(Stepper& stepper, const double* x, Interval interval) { return !reached_ || respond(stepper, x, interval); }

  /// After look_ahead(), for recall().
  void keep(FilterTrace& trace) const;
  /// Instead of look_ahead(), at the step of this number (0: the first) in a run about `trace`: adds to `shift` what the past does to the
  /// state after it, being estimated otherwise here than there.
  template <class StateVector>
  void recall(const FilterTrace& trace, std::size_t step, StateVector& shift) {
    if (reached_) recall_into(trace, step, shift.data());
  }

  /// After Kalman::predict() with the same Φ, whose rows and columns are so far apart: [x | e | c] jointly, c constant.
  template <int M, int NY>
  void predict(const double* phi, Strides apart, const NoiseStep& noise, Kalman<M, NY>& kalman) {
    if (reached_) predict_jointly(phi, apart, noise, kalman.P, kalman.C);
  }

  /// After Kalman::update() by a measurement of channel o with the row `a` of ∂h/∂x.
  template <int M, int NY>
  void update(const typename Kalman<M, NY>::StateVector& a, int o, const Kalman<M, NY>& kalman, double innovation, double S) {
    if (reached_) update_jointly(a, o, kalman.gain, kalman.gain_coloured, innovation, S);
  }

 private:
  struct PastInput {
    int index;
    double sigma;
  };
  using PastVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxInputs, 1>;
  using Across = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxStates, kMaxInputs>;
  using ColouredAcross = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 2 * kMaxOutputs, kMaxInputs>;
  using MatrixRef = Eigen::Ref<Eigen::MatrixXd>;
  using VectorRef = Eigen::Ref<const Eigen::VectorXd>;

  bool respond(Stepper& stepper, const double* x, Interval interval);
  void recall_into(const FilterTrace& trace, std::size_t step, double* shift);
  void predict_jointly(const double* phi, Strides apart, const NoiseStep& noise, MatrixRef P, MatrixRef C);
  void update_jointly(const VectorRef& a, int o, const VectorRef& gain, const VectorRef& gain_coloured, double innovation, double S);

  std::vector<PastInput> inputs_;
  bool reached_ = false;
  std::array<double, kMaxInputs> mean_{};
  Across X_, G_;      ///< covariance of x and c; response
  ColouredAcross J_;  ///< covariance of the coloured noise and c
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxInputs, kMaxInputs> V_;
  PastVector gain_;
};

}  // namespace misfit
