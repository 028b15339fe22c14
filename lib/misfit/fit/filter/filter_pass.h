#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "misfit/fit/filter/filter_sensitivities.h"
#include "misfit/fit/filter/filter_steps.h"
#include "misfit/fit/filter/unknown_past.h"
#include "misfit/sim/sampled_outputs.h"

namespace misfit {

/// What a pass of the filter works on.
struct FilterPassInput {
  const FilterModel& model;
  const FilterData& data;
  const FilterNoise& noise;
  FilterRunOptions options;
};

/// One pass of the extended Kalman filter over one experiment, sample by sample. M, NY as in Kalman.
template <int M, int NY>
class FilterPass {
 public:
  FilterPass(const FilterPassInput& input, Stepper& stepper, FilterTrace& trace)
      : model_(input.model),
        stepper_(stepper),
        evaluator_(stepper.evaluator()),
        data_(input.data),
        signals_(*input.data.signals),
        noise_(input.noise),
        trace_(trace),
        options_(input.options),
        n_(stepper.states()),
        ny_(evaluator_.outputs()),
        N_(n_),
        kalman_(n_, ny_),
        past_(model_, data_, n_, ny_),
        steps_(input.noise),
        D_(N_ * kRowStride),
        outputs_(stepper),
        a_(StateVector::Zero(n_)) {
    start_covariance(model_, data_, noise_, kalman_);
    if (options_.jacobian != nullptr) sensitivities_.begin(*options_.jacobian, data_, {n_, ny_, evaluator_.columns(), past_.count()});
    std::copy_n(data_.start.data(), n_, x_.begin());
    prepare_at({stepper_, signals_, data_.inputs}, data_.first, x_.data());
  }

  bool run() {
    for (std::size_t k = data_.first; k < trace_.end; ++k) {
      if (!predict_outputs(k)) return fails(k);
      for (int o = 0; o < ny_; ++o) {
        if (!update_by(k, o)) return fails(k);
      }
      correct_state(k);
      if (k + 1 < trace_.end && !step(k)) return fails(k);
    }
    trace_.finite = std::isfinite(trace_.loglik);
    return trace_.finite;
  }

 private:
  using StateVector = typename Kalman<M, NY>::StateVector;
  static constexpr Eigen::Index twice(int count) { return 2 * static_cast<Eigen::Index>(count); }
  [[nodiscard]] double step_of(int o) const { return data_.steps.empty() ? 0.0 : data_.steps[o]; }

  bool fails(std::size_t k) {
    trace_.failed_at = k;
    return false;
  }

  /// Outputs, their rows and their variances before the update by any measurement of the sample. False where one
  /// cannot be predicted.
  [[nodiscard]] bool predict_outputs(std::size_t k) {
    const std::size_t NY_ = ny_;
    std::copy_n(x_.begin(), n_, trace_.predicted.begin() + (k * N_));
    if (options_.keep_P) {
      double* at = trace_.P.data() + k * N_ * (N_ + 2 * NY_);
      for (int i = 0; i < n_; ++i) {
        for (int j = 0; j < n_; ++j) *at++ = kalman_.P(i, j);
        for (int j = 0; j < 2 * ny_; ++j) *at++ = kalman_.C(i, j);
      }
    }
    if (!outputs_.linearise({stepper_, signals_, data_.inputs}, k, x_.data(), slots_)) return false;
    kalman_.x.setZero();
    for (int o = 0; o < ny_; ++o) {
      const std::size_t at = trace_.place(k, o);
      const std::size_t channel = o;
      for (int i = 0; i < n_; ++i) a_[i] = outputs_.row(o)[i];
      std::copy_n(a_.data(), n_, trace_.H.data() + at * N_);
      trace_.y[at] = outputs_.y(o) + kalman_.j[twice(o)];
      const double step = step_of(o);
      trace_.y_variance[at] = kalman_.variance(a_, o, noise_.channels[channel].white) + step * step / 12.0;
    }
    return true;
  }

  /// False if the innovation is not a number.
  bool update_by(std::size_t k, int o) {
    const std::size_t at = trace_.place(k, o);
    const std::size_t channel = o;
    const SampleRole use = data_.use[at];
    if (use == SampleRole::none) return true;
    a_ = trace_.H_at(at);
    const double variance = kalman_.variance(a_, o, noise_.channels[channel].white);
    const double z = signals_.measured[channel].values[k] - outputs_.y(o);
    const double departure = z - a_.dot(kalman_.x) - kalman_.j[twice(o)];
    if (!(variance > 0.0) || !std::isfinite(departure)) return false;
    const double gate = kOutlierGate * std::sqrt(variance) + 0.5 * step_of(o);
    if (options_.rejected != nullptr && is_wild(at, channel, std::abs(departure) > gate)) return true;
    trace_.z[at] = z;
    const Reading reading = trace_.take(at, departure, variance, step_of(o));
    if (!std::isfinite(reading.minus_log)) return false;
    count(use, -reading.minus_log);
    kalman_.update(reading.e, reading.S);
    past_.update(a_, o, kalman_, reading.e, reading.S);
    std::copy_n(kalman_.gain.data(), n_, trace_.K.data() + at * N_);
    std::copy_n(kalman_.gain_coloured.data(), 2 * ny_, trace_.Kj.data() + at * 2 * ny_);
    if (options_.jacobian == nullptr) return true;
    sensitivities_.predict_output(trace_.H.data() + at * N_, o, outputs_.row(o) + n_, slots_);
    if (use == SampleRole::counted) sensitivities_.keep(at, trace_);
    sensitivities_.update(kalman_.gain.data(), kalman_.gain_coloured.data());
    if (past_.is_reached()) sensitivities_.update_past(past_.gain().data());
    return true;
  }

  /// Keeps the list of measurements set aside: those beyond the gate, unless more than kLongestWildRun of the channel follow each other.
  bool is_wild(std::size_t at, std::size_t channel, bool beyond) {
    int& run = wild_run_[channel];
    if (!beyond) run = 0;
    if (!beyond || run < 0) return false;
    if (++run <= kLongestWildRun) {
      options_.rejected->push_back(at);
      return true;
    }
    auto& aside = *options_.rejected;
    const std::size_t width = ny_;
    for (std::size_t kept = kLongestWildRun, i = aside.size(); kept > 0 && i-- > 0;) {
      if (aside[i] % width != channel) continue;
      aside.erase(aside.begin() + i);
      --kept;
    }
    run = -1;  // lost: all measurements are used until one is within the gate
    return false;
  }

  void count(SampleRole use, double log_density) {
    if (use == SampleRole::counted) {
      trace_.loglik += log_density;
      ++trace_.counted;
    } else if (use == SampleRole::validation) {
      trace_.validation_loglik += log_density;
      ++trace_.validated;
    }
  }

  void correct_state(std::size_t k) {
    for (int i = 0; i < n_; ++i) {
      trace_.correction[k * N_ + i] = kalman_.x[i];
      x_[i] += kalman_.x[i];
    }
  }

  bool step(std::size_t k) {
    Interval interval = interval_after({stepper_, signals_, data_.inputs}, k);
    if (!past_.look_ahead(stepper_, x_.data(), interval)) return false;
    interval.u0.before = past_.before();
    past_.keep(trace_);
    if (!stepper_.step_linear(x_.data(), interval, slots_, D_.data())) return false;
    const Eigen::Map<const Eigen::Matrix<double, M, M, M == 1 ? Eigen::ColMajor : Eigen::RowMajor>, 0, Eigen::OuterStride<>> phi(
        D_.data(), n_, n_, Eigen::OuterStride<>(kRowStride));
    for (int i = 0; i < n_; ++i)
      std::copy_n(D_.data() + static_cast<std::size_t>(i) * kRowStride, n_, trace_.Phi.data() + (k * N_ + i) * N_);
    const NoiseStep& noise_step = steps_.at(interval.t1 - interval.t0);
    kalman_.predict(phi, noise_step, model_);
    past_.predict(D_.data(), {.row = static_cast<Eigen::Index>(kRowStride), .column = 1}, noise_step, kalman_);
    if (options_.jacobian == nullptr) return true;
    sensitivities_.step(D_.data(), slots_, noise_step);
    if (past_.is_reached()) sensitivities_.add_past(past_.response());
    return true;
  }

  const FilterModel& model_;
  Stepper& stepper_;
  Evaluator& evaluator_;
  const FilterData& data_;
  const Signals& signals_;
  const FilterNoise& noise_;
  FilterTrace& trace_;
  FilterRunOptions options_;
  int n_, ny_;
  std::size_t N_;
  Kalman<M, NY> kalman_;
  UnknownPast past_;
  NoiseSteps steps_;
  std::vector<double> D_;
  SampledOutputs outputs_;
  StateVector a_;
  Slots slots_;
  std::array<double, kMaxStates> x_{};
  std::array<int, kMaxOutputs> wild_run_{};  // measurements beyond the gate in a row; -1: too many
  FilterSensitivities sensitivities_;
};

}  // namespace misfit
