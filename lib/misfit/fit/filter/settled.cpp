#include "misfit/fit/filter/settled.h"

#include <cmath>
#include <utility>

#include "misfit/math/statistics.h"

namespace misfit {

SettledPredictions::SettledPredictions(const FilterTrace& trace, const FilterData& data) : trace_(&trace) {
  for (std::size_t o = 0; o < static_cast<std::size_t>(trace.ny); ++o) {
    std::vector<double> sigma;
    for (std::size_t k = 0; k < trace.samples; ++k) {
      const std::size_t at = trace.place(k, o);
      if (data.use[at] != SampleRole::none) sigma.push_back(std::sqrt(trace.y_variance[at]));
    }
    largest_.push_back(std::pow(largest_usual_sigma(std::move(sigma)), 2));
  }
}

bool SettledPredictions::settled(std::size_t sample, std::size_t channel) const {
  return trace_->y_variance[trace_->place(sample, channel)] <= largest_[channel];
}

bool SettledPredictions::all_settled(std::size_t sample) const {
  for (std::size_t o = 0; o < largest_.size(); ++o) {
    if (!settled(sample, o)) return false;
  }
  return true;
}

}  // namespace misfit
