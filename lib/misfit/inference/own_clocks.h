#pragma once

#include <Eigen/Core>

#include "misfit/data/signals.h"

namespace misfit {

/// How often two channels are measured at the same sample.
class MeasuredTogether {
 public:
  explicit MeasuredTogether(Eigen::Index channels) : pairs_(Eigen::MatrixXd::Zero(channels, channels)) {}

  /// A sample at which the channels of 1 are measured, those of 0 are not.
  void add(const Eigen::VectorXd& measured) { pairs_ += measured * measured.transpose(); }

  /// Some two channels share less than half of the measurements of the one that has fewer: their sensors have clocks of their own.
  [[nodiscard]] bool have_own_clocks() const;

 private:
  Eigen::MatrixXd pairs_;
};

[[nodiscard]] bool have_own_clocks(const Signals& signals);

/// Usual step between the measurements of a channel [s]; between the rows where it has fewer than two.
[[nodiscard]] double own_step(const Signals& signals, std::size_t channel);

/// Usual step between the rows [s]; where sensors have clocks of their own, between the measurements of the fastest one.
[[nodiscard]] double step_of_measurements(const Signals& signals);

}  // namespace misfit
