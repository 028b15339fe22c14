#pragma once

#include <vector>

#include "misfit/fit/filter/filter_run.h"

namespace misfit {

/// Which one-step predictions say something of the model: those whose sigma is at most largest_usual_sigma() of the channel's
/// measurements in use. At the beginning, where the rates are not known yet, and behind long gaps a prediction is as wide as what can be at
/// all; the likelihood weighs it so, but one such error would make up the whole of an RMS.
class SettledPredictions {
 public:
  /// Keeps a pointer to the trace.
  SettledPredictions(const FilterTrace& trace, const FilterData& data);

  [[nodiscard]] bool settled(std::size_t sample, std::size_t channel) const;
  [[nodiscard]] bool all_settled(std::size_t sample) const;

 private:
  const FilterTrace* trace_;
  std::vector<double> largest_;  ///< variance, per channel
};

/// Which predictions kLadderSteps samples ahead say something of the model: those whose sigma is at most three times the median of all of
/// that length and channel. A state that the first samples hardly show, as the speed of what is measured by its place, leaves predictions
/// of one sample sure and those far ahead of any size: a handful of them would make up the RMS. Of a run from sample k, at sample m,
///   sigma^2 = H_m Phi P Phi^T H_m^T + S_m,
/// P the covariance of the state predicted for sample k + 1, Phi the product of the linearised steps from there to m, S_m the variance of
/// the prediction of one sample; the random force between is left out, since it is the same for all.
class SettledAhead {
 public:
  /// Of runs from every `stride`-th sample behind `first`. A trace without covariances (FilterRunOptions::keep_P): all are settled.
  SettledAhead(const FilterTrace& trace, std::size_t first, std::size_t stride);

  /// `length`: place in kLadderSteps. False where no run from k reaches so far.
  [[nodiscard]] bool settled(std::size_t k, std::size_t length, std::size_t channel) const;

 private:
  [[nodiscard]] std::size_t place(std::size_t k, std::size_t length, std::size_t channel) const;
  void follow(const FilterTrace& trace, std::size_t k);
  [[nodiscard]] double largest_of(std::size_t length, std::size_t channel) const;

  std::size_t first_, stride_, channels_;
  std::vector<double> sigma_;    ///< [run][length][channel]; NaN: none reaches there
  std::vector<double> largest_;  ///< [length][channel]
};

}  // namespace misfit
