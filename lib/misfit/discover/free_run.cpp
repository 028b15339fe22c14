#include "misfit/discover/free_run.h"

#include <algorithm>
#include <cmath>

#include "misfit/core/error.h"
#include "misfit/core/watch.h"
#include "misfit/discover/refit.h"
#include "misfit/math/statistics.h"

namespace misfit {
namespace {

/// Of the squares of the free run that a force explains.
constexpr double least_share = 0.2;

/// Usual size of the counted innovations of every output, and how many times larger than expected they are: medians of their sizes, so that
/// the first samples, which are far from a start that nobody knows, do not count.
struct Sizes {
  std::vector<double> size, ratio;
};

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

/// Fitted by a free run; nullopt: it cannot be, or gets lost.
std::optional<FilterEstimate> fitted_freely(const FilterEstimate& estimate, const FreeRunWork& work) {
  try {
    return estimate_freely(estimate.model, estimate.penalties, work.experiments, options_like(estimate, work.threads));
  } catch (const TimeLimitReached&) {
    throw;
  } catch (const RunError&) {
    return std::nullopt;
  }
}

/// Mean logarithm of the white noise of the outputs.
double log_noise(const FilterEstimate& estimate) {
  double sum = 0.0;
  for (const ChannelNoise& channel : estimate.noise.channels) sum += std::log(channel.white);
  return sum / static_cast<double>(estimate.noise.channels.size());
}

/// `at` run freely, with as much white noise as that leaves; nullopt: it cannot be run so.
std::optional<FilterEstimate> run_freely(FilterEstimate at, const FilterNoise& noise) {
  constexpr int rounds = 3;  // of the size of the noise: initial states are weighed by it
  at.noise = hardly_forced(noise, at.reference);
  FilterRunner runner(at.forced, true);
  runner.set_parameters(at.forced.model.values());
  for (int round = 0; round < rounds; ++round) {
    at.loglik = 0.0;
    for (std::size_t e = 0; e < at.data.size(); ++e) {
      if (!runner.run(at.data[e], at.noise, at.traces[e], {&at.jacobians[e]})) return std::nullopt;
      at.loglik += at.traces[e].loglik;
    }
    const Sizes now = sizes_of(at.traces, at.data, at.noise.channels.size());
    for (std::size_t o = 0; round + 1 < rounds && o < now.size.size(); ++o) {
      if (now.ratio[o] > 0.0) at.noise.channels[o].white *= now.ratio[o];
    }
  }
  at.objective = at.loglik + at.prior().log_density(at.model.theta());
  return at;
}

bool shows_more(const FilterEstimate& calm, const Sizes& one_step) {
  constexpr double least = 1.2;
  const Sizes now = sizes_of(calm.traces, calm.data, calm.noise.channels.size());
  bool larger = false;
  for (std::size_t o = 0; o < now.size.size(); ++o) larger = larger || now.size[o] > least * one_step.size[o];
  return larger;
}

}  // namespace

std::optional<FilterEstimate> free_run(const FilterEstimate& estimate, const FreeRunWork& work) {
  const Sizes one_step = sizes_of(estimate.traces, estimate.data, estimate.noise.channels.size());
  std::optional<FilterEstimate> out = run_freely(estimate, estimate.noise);
  if (!out || !shows_more(*out, one_step)) return std::nullopt;
  const std::optional<FilterEstimate> fitted = fitted_freely(*out, work);
  std::optional<FilterEstimate> there = fitted ? run_freely(*fitted, estimate.noise) : std::nullopt;
  if (!there || !(log_noise(*there) < log_noise(*out))) return out;
  return shows_more(*there, one_step) ? there : std::nullopt;
}

std::vector<const ScreeningResult*> forces_shown_by(const FilterEstimate& calm, const std::vector<ScreeningResult>& screened) {
  constexpr std::size_t most = 3;
  double counted = 0.0;
  for (const FilterTrace& trace : calm.traces) counted += static_cast<double>(trace.counted);
  std::vector<const ScreeningResult*> all;
  for (const ScreeningResult& s : screened) {
    const bool a_force = s.candidate_model->family != CandidateFamily::sensor;  // the random force takes over nothing else
    if (a_force && s.runs && s.result.dof > 0 && s.result.chi2 > least_share * counted) all.push_back(&s);
  }
  std::stable_sort(all.begin(), all.end(), [](const auto* a, const auto* b) { return a->result.chi2 > b->result.chi2; });
  std::vector<const ScreeningResult*> out(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), most)));
  for (const ScreeningResult* s : all) {
    const auto same_place = [&](const ScreeningResult* o) { return o->candidate_model->port_names == s->candidate_model->port_names; };
    if (out.size() < 2 * most && std::none_of(out.begin(), out.end(), same_place)) out.push_back(s);
  }
  return out;
}

bool is_explained(const FilterEstimate& calm, const FilterEstimate& after) {
  return std::exp(2.0 * (log_noise(after) - log_noise(calm))) < 1.0 - least_share;
}

}  // namespace misfit
