#include "misfit/discover/free_run.h"

#include <algorithm>
#include <cmath>

namespace misfit {
namespace {

/// Of the squares of the free run that a force explains.
constexpr double least_share = 0.2;

/// Usual size of the counted innovations of every output, and how many times larger than expected they are: medians of their sizes, so that
/// the first samples, which are far from a start that nobody knows, do not count.
struct Sizes {
  std::vector<double> size, ratio;
};

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + values.size() / 2;
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
  out.noise = hardly_forced(estimate.noise, estimate.reference);
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

std::vector<const ScreeningResult*> forces_shown_by(const FilterEstimate& calm, const std::vector<ScreeningResult>& screened) {
  constexpr std::size_t most = 3;
  double counted = 0.0;
  for (const FilterTrace& trace : calm.traces) counted += static_cast<double>(trace.counted);
  std::vector<const ScreeningResult*> out;
  for (const ScreeningResult& s : screened) {
    const bool a_force = s.candidate_model->family != CandidateFamily::sensor;  // the random force takes over nothing else
    if (a_force && s.runs && s.result.dof > 0 && s.result.chi2 > least_share * counted) out.push_back(&s);
  }
  std::stable_sort(out.begin(), out.end(), [](const auto* a, const auto* b) { return a->result.chi2 > b->result.chi2; });
  out.resize(std::min(out.size(), most));
  return out;
}

bool is_explained(const FilterEstimate& calm, const FilterEstimate& after) {
  double log_ratio = 0.0;
  for (std::size_t o = 0; o < after.noise.channels.size(); ++o)
    log_ratio += std::log(after.noise.channels[o].white / calm.noise.channels[o].white);
  return std::exp(2.0 * log_ratio / static_cast<double>(after.noise.channels.size())) < 1.0 - least_share;
}

}  // namespace misfit
