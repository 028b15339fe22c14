#include "misfit/fit/filter/settled.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "misfit/data/ladder.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

constexpr std::size_t lengths = std::size(kLadderSteps);

}  // namespace

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

SettledAhead::SettledAhead(const FilterTrace& trace, std::size_t first, std::size_t stride)
    : first_(first), stride_(stride), channels_(static_cast<std::size_t>(trace.ny)) {
  if (trace.P.empty() || first >= trace.samples) return;
  sigma_.assign(((trace.samples - first - 1) / stride + 1) * lengths * channels_, std::nan(""));
  for (std::size_t k = first; k + 1 < trace.samples; k += stride) follow(trace, k);
  for (std::size_t l = 0; l < lengths; ++l) {
    for (std::size_t o = 0; o < channels_; ++o) largest_.push_back(largest_of(l, o));
  }
}

bool SettledAhead::settled(std::size_t k, std::size_t length, std::size_t channel) const {
  return sigma_.empty() || sigma_[place(k, length, channel)] <= largest_[length * channels_ + channel];
}

std::size_t SettledAhead::place(std::size_t k, std::size_t length, std::size_t channel) const {
  return ((k - first_) / stride_ * lengths + length) * channels_ + channel;
}

void SettledAhead::follow(const FilterTrace& trace, std::size_t k) {
  const Eigen::Index n = trace.n, columns = n + 2 * Eigen::Index{trace.ny};
  const Eigen::Map<const RowMatrix> P(trace.P.data() + (k + 1) * static_cast<std::size_t>(n * columns), n, columns);
  RowMatrix to_there = RowMatrix::Identity(n, n);
  std::size_t next = 0;
  for (std::size_t j = 1; next < lengths && k + j < trace.samples; ++j) {
    if (j > 1) to_there = trace.Phi_at(k + j - 1) * to_there;
    if (static_cast<int>(j) != kLadderSteps[next]) continue;
    for (std::size_t o = 0; o < channels_; ++o) {
      const std::size_t at = trace.place(k + j, o);
      const Eigen::RowVectorXd row = trace.H_at(at).transpose() * to_there;
      const double of_state = row * P.leftCols(n) * row.transpose();
      sigma_[place(k, next, o)] = std::sqrt(std::max(of_state, 0.0) + trace.y_variance[at]);
    }
    ++next;
  }
}

double SettledAhead::largest_of(std::size_t length, std::size_t channel) const {
  constexpr double ratio = 3.0;
  std::vector<double> all;
  for (std::size_t at = length * channels_ + channel; at < sigma_.size(); at += lengths * channels_) {
    if (std::isfinite(sigma_[at])) all.push_back(sigma_[at]);
  }
  return all.empty() ? 0.0 : ratio * median(std::move(all));
}

}  // namespace misfit
