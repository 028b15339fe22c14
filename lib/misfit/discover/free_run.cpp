#include "misfit/discover/free_run.h"

#include <algorithm>
#include <cmath>

namespace misfit {
namespace {

/// RMS of the counted innovations of every output, and how many times larger they are than expected.
struct Sizes {
  std::vector<double> rms, ratio;
};

Sizes sizes_of(const std::vector<FilterTrace>& traces, const std::vector<FilterData>& data, std::size_t outputs) {
  Sizes out{std::vector<double>(outputs, 0.0), std::vector<double>(outputs, 0.0)};
  std::vector<double> count(outputs, 0.0);
  for (std::size_t e = 0; e < traces.size(); ++e) {
    for (std::size_t k = data[e].first; k < traces[e].samples; ++k) {
      for (std::size_t o = 0; o < outputs; ++o) {
        const std::size_t at = traces[e].place(k, o);
        if (!(traces[e].S[at] > 0.0) || data[e].use[at] != SampleRole::counted) continue;
        out.rms[o] += traces[e].e[at] * traces[e].e[at];
        out.ratio[o] += traces[e].e[at] * traces[e].e[at] / traces[e].S[at];
        count[o] += 1.0;
      }
    }
  }
  for (std::size_t o = 0; o < outputs; ++o) {
    out.rms[o] = std::sqrt(out.rms[o] / std::max(count[o], 1.0));
    out.ratio[o] = std::sqrt(out.ratio[o] / std::max(count[o], 1.0));
  }
  return out;
}

/// The least random force that its bounds allow, and no jitter beside the white noise.
FilterNoise without_force(const FilterEstimate& estimate) {
  constexpr double nearly_nothing = 1e-3;
  FilterNoise out = estimate.noise;
  out.force = nearly_nothing * estimate.around.force;
  for (std::size_t g = 0; g < out.further_forces.size(); ++g) out.further_forces[g] = nearly_nothing * estimate.around.further_forces[g];
  for (ChannelNoise& channel : out.channels) {
    channel.white = std::hypot(channel.white, channel.jitter);
    channel.jitter = nearly_nothing * channel.white;
  }
  return out;
}

}  // namespace

std::optional<FilterEstimate> free_run(const FilterEstimate& estimate) {
  constexpr double least = 1.2;
  constexpr int rounds = 3;  // of the size of the noise: initial states are weighed by it
  FilterEstimate out = estimate;
  out.noise = without_force(estimate);
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
    for (std::size_t o = 0; o < now.rms.size(); ++o) {
      larger = larger || now.rms[o] > least * one_step.rms[o];
      if (round + 1 < rounds && now.ratio[o] > 0.0) out.noise.channels[o].white *= now.ratio[o];
    }
    if (!larger) return std::nullopt;
  }
  out.objective = out.loglik + out.prior().log_density(out.model.theta());
  return out;
}

}  // namespace misfit
