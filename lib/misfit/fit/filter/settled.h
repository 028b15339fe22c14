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

}  // namespace misfit
