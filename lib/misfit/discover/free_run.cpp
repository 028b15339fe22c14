#include "misfit/discover/free_run.h"

#include <algorithm>
#include <cmath>

namespace misfit {
namespace {

/// Usual size of the counted innovations of every output, and how many times larger than expected they are: medians of their sizes, so that
/// the first samples, which are far from a start that nobody knows, do not count.
struct Sizes {
  std::vector<double> size, ratio;
};

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Sizes sizes_of(const std::vector<FilterTrace>& traces, const std::vector<FilterData>& data, std::size_t outputs) {
  constexpr double of_normal = 0.6745;  // median of |z|
  std::vector<std::vector<double>> size(outputs), ratio(outputs);
  for (std::size_t e = 0; e < traces.size(); ++e) {
    for (std::size_t k = data[e].first; k < traces[e].samples; ++k) {
      for (std::size_t o = 0; o < outputs; ++o) {
        const std::size_t at = traces[e].place(k, o);
        if (!(traces[e].S[at] > 0.0) || data[e].use[at] != SampleRole::counted) continue;
        size[o].push_back(std::abs(traces[e].e[at]));
        ratio[o].push_back(std::abs(traces[e].e[at]) / std::sqrt(traces[e].S[at]));
      }
    }
  }
  Sizes out;
  for (std::size_t o = 0; o < outputs; ++o) {
    out.size.push_back(median(std::move(size[o])) / of_normal);
    out.ratio.push_back(median(std::move(ratio[o])) / of_normal);
  }
  return out;
}

}  // namespace

std::optional<FilterEstimate> free_run(const FilterEstimate& estimate) {
  constexpr double least = 1.2;
  constexpr int rounds = 3;  // of the size of the noise: initial states are weighed by it
  FilterEstimate out = estimate;
  out.noise = hardly_forced(estimate.noise, estimate.around);
  const Sizes one_step = sizes_of(estimate.traces, estimate.data, out.noise.channels.size());
  FilterRunner runner(out.forced, true);
  runner.set_parameters(out.forced.model.values());
  for (int round = 0; round < rounds; ++round) {
    out.loglik = 0.0;
    for (std::size_t e = 0; e < out.data.size(); ++e) {
      if (!runner.run(out.data[e], out.noise, out.traces[e], {&out.jacobians[e]})) return std::nullopt;
      out.loglik += out.traces[e].loglik;
    }
    const Sizes now = sizes_of(out.traces, out.data, out.noise.channels.size());
    bool larger = false;
    for (std::size_t o = 0; o < now.size.size(); ++o) {
      larger = larger || now.size[o] > least * one_step.size[o];
      if (round + 1 < rounds && now.ratio[o] > 0.0) out.noise.channels[o].white *= now.ratio[o];
    }
    if (!larger) return std::nullopt;
  }
  out.objective = out.loglik + out.prior().log_density(out.model.theta());
  return out;
}

}  // namespace misfit
