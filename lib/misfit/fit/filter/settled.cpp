#include "misfit/fit/filter/settled.h"

#include <algorithm>
#include <limits>

namespace misfit {

SettledPredictions::SettledPredictions(const FilterTrace& trace, const FilterData& data) : trace_(&trace) {
  constexpr double largest_ratio = 10.0;
  for (std::size_t o = 0; o < static_cast<std::size_t>(trace.ny); ++o) {
    std::vector<double> variances;
    for (std::size_t k = 0; k < trace.samples; ++k) {
      const std::size_t at = trace.place(k, o);
      if (data.use[at] != SampleRole::none) variances.push_back(trace.y_variance[at]);
    }
    const auto middle = variances.begin() + static_cast<std::ptrdiff_t>(variances.size() / 2);
    std::nth_element(variances.begin(), middle, variances.end());
    largest_.push_back(variances.empty() ? std::numeric_limits<double>::infinity() : largest_ratio * largest_ratio * *middle);
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
